set(MAPPER_INTEGRATE_TESTS
  integrate_label_counts.cpp
  integrate_occupancy.cpp
  integrate_reference.cpp
  mesh_marching_cubes.cpp
  output_archive.cpp
  output_files.cpp)
