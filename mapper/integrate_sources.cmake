set(MAPPER_INTEGRATE_SOURCES
  integrate/free_space.cpp
  integrate/grouped_ray_integrator.cpp
  integrate/label_counts.cpp
  integrate/marching_cubes_table.cpp
  integrate/mesher.cpp
  integrate/point_groups.cpp
  integrate/tsdf_volume.cpp)
