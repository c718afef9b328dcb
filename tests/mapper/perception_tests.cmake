set(MAPPER_PERCEPTION_TESTS
  associate_paper.cpp
  detect_boxes.cpp
  detect_yolo.cpp
  localise_localisers.cpp
  localise_scan_matcher.cpp
  segment_cuboid_search.cpp
  segment_paper.cpp)
