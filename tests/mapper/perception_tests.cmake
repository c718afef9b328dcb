set(MAPPER_PERCEPTION_TESTS
  detect_boxes.cpp
  detect_yolo.cpp
  localise_scan_matcher.cpp
  segment_paper.cpp)
