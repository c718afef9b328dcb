set(MAPPER_PERCEPTION_TESTS
  localise_scan_matcher.cpp)
