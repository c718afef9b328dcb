set(MAPPER_INTEGRATE_SOURCES
  integrate/label_counts.cpp
  integrate/tsdf_volume.cpp)
