# The shipped halls and the kit that builds them.
waretwin_test(builder
  SOURCES builder_halls_test.cpp builder_shape_test.cpp
  LIBRARIES waretwin::scenes waretwin::builder)
