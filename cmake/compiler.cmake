# Language level, warnings and sanitizers for every target of this package.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "Build type" FORCE)
endif()
# -g1 keeps line numbers in backtraces without the size of full debug information. No -march=native: a nodelet shares Eigen
# objects with other libraries in its process. No contraction: the same bytes on every machine. Nobody reads
# errno or floating-point flags after sqrt, which lets loops with it be vectorised.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O3 -g1 -DNDEBUG")

add_library(depth_object_tracker_warnings INTERFACE)
target_compile_options(depth_object_tracker_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wconversion -Wno-sign-conversion
  -ffp-contract=off -fno-math-errno -fno-trapping-math $<$<BOOL:${WARNINGS_AS_ERRORS}>:-Werror>)

if(SANITIZE)
  # -O2 after the build type's own: stacks that can be read (tests: -O1, quicker to compile). Two instruction sets of
  # Highway are enough.
  add_compile_options(-O2 -fsanitize=${SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SANITIZE})
  # Under gcc's AddressSanitizer Eigen would align memory in its own way, unlike the same functions in Debian's orocos-kdl.
  add_compile_definitions(EIGEN_INITIALIZE_MATRICES_BY_NAN EIGEN_MALLOC_ALREADY_ALIGNED=1 DEPTH_OBJECT_TRACKER_FEW_TARGETS)
endif()

# count_lines(TARGET): with COVERAGE the lines that run in it are counted. Only what is measured counts: the tests and the simulator
# stay fast. Plain counters, which optimisation moves out of loops: threads may lose a count between them, never a line that has run.
function(count_lines target)
  if(COVERAGE)
    target_compile_options(${target} PRIVATE -O2 --coverage -fprofile-update=single)
    target_link_options(${target} PRIVATE --coverage)
    # Two instruction sets of Highway do as well: the same lines are compiled for each.
    target_compile_definitions(${target} PRIVATE DEPTH_OBJECT_TRACKER_FEW_TARGETS)
  endif()
endfunction()
