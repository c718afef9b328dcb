set(MAPPER_PERCEPTION_SOURCES
  localise/laser_icp_localiser.cpp
  localise/odometry_history.cpp
  localise/point_to_line.cpp
  localise/scan_matcher.cpp
  localise/simple_localisers.cpp
  segment/cuboid_search.cpp)
