# One place for language level, warnings, sanitizers and the build helpers that are used when present.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(WARETWIN_CCACHE ccache)
if(WARETWIN_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${WARETWIN_CCACHE}")
endif()

add_library(waretwin_flags INTERFACE)
add_library(waretwin::flags ALIAS waretwin_flags)
target_compile_options(waretwin_flags INTERFACE
  -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
  # GCC 12 sees overlapping copies in std::string's own operator+ (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # Fused multiply-add changes last bits from one CPU to the next; a run must not.
  -ffp-contract=off
  # Nobody reads errno or floating-point flags: square roots and roundings become single instructions.
  -fno-math-errno -fno-trapping-math)
if(WARETWIN_ARCH)
  target_compile_options(waretwin_flags INTERFACE -march=${WARETWIN_ARCH})
endif()
if(WARETWIN_WERROR)
  target_compile_options(waretwin_flags INTERFACE -Werror)
endif()
if(WARETWIN_CHECKS OR WARETWIN_TESTS)
  target_compile_definitions(waretwin_flags INTERFACE WARETWIN_CHECKS_ARMED)
endif()
if(WARETWIN_SANITIZE)
  add_compile_options(-fsanitize=${WARETWIN_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${WARETWIN_SANITIZE})
endif()
