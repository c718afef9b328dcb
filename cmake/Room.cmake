# waretwin_room(NAME SOURCES ... PUBLIC ... PRIVATE ...)
# One library per room, waretwin::NAME. PUBLIC holds the rooms it may see and the packages that its headers show; packages used only
# in its .cpp files are PRIVATE. Package headers are SYSTEM, so that their warnings are not ours.
function(waretwin_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(waretwin_${name} STATIC ${ROOM_SOURCES})
  add_library(waretwin::${name} ALIAS waretwin_${name})
  target_include_directories(waretwin_${name} PUBLIC "${CMAKE_SOURCE_DIR}" "${CMAKE_BINARY_DIR}/generated")
  target_link_libraries(waretwin_${name} PUBLIC ${ROOM_PUBLIC} PRIVATE waretwin::flags ${ROOM_PRIVATE})
endfunction()

# waretwin_test(ROOM SOURCES ... LIBRARIES ...): one GoogleTest program per room, ROOM_test, each case a ctest test.
function(waretwin_test room)
  cmake_parse_arguments(T "" "TIMEOUT" "SOURCES;LIBRARIES" ${ARGN})
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 120)
  endif()
  if(WARETWIN_SANITIZE)
    math(EXPR T_TIMEOUT "10 * ${T_TIMEOUT}")
  endif()
  add_executable(${room}_test ${T_SOURCES})
  target_link_libraries(${room}_test PRIVATE ${T_LIBRARIES} waretwin::flags GTest::gtest GTest::gtest_main)
  target_compile_definitions(${room}_test PRIVATE
    WARETWIN_SOURCE_DIR="${CMAKE_SOURCE_DIR}" WARETWIN_TEST_DATA="${WARETWIN_TEST_DATA}")
  gtest_discover_tests(${room}_test TEST_PREFIX "${room}." DISCOVERY_TIMEOUT 60
    PROPERTIES TIMEOUT ${T_TIMEOUT} ENVIRONMENT "TSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/sanitizers/tsan.supp")
endfunction()
