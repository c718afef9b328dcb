set(MAPPER_PERCEPTION_SOURCES
  segment/cuboid_search.cpp)
