# Programs that measure speed; not part of the tests. engine_benchmark is installed beside track_sequence.
add_library(depth_object_tracker_benchmark_support STATIC
  ${CMAKE_CURRENT_LIST_DIR}/benchmark_object.cpp
  ${CMAKE_CURRENT_LIST_DIR}/benchmark_scene.cpp
)
target_link_libraries(depth_object_tracker_benchmark_support
  PUBLIC depth_object_tracker_core
  PRIVATE depth_object_tracker_warnings)

add_executable(engine_benchmark
  ${CMAKE_CURRENT_LIST_DIR}/allocation_counter.cpp
  ${CMAKE_CURRENT_LIST_DIR}/benchmark_report.cpp
  ${CMAKE_CURRENT_LIST_DIR}/engine_benchmark.cpp
  ${CMAKE_CURRENT_LIST_DIR}/machine_info.cpp
  ${CMAKE_CURRENT_LIST_DIR}/memory_use.cpp
  ${CMAKE_CURRENT_LIST_DIR}/stage_timing.cpp
  ${CMAKE_CURRENT_LIST_DIR}/update_timing.cpp
)
target_link_libraries(engine_benchmark PRIVATE
  depth_object_tracker_benchmark_support depth_object_tracker_warnings CLI11::CLI11 nlohmann_json::nlohmann_json)
target_compile_definitions(engine_benchmark PRIVATE
  PROJECT_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}" BUILD_TYPE="${CMAKE_BUILD_TYPE}")

find_package(benchmark QUIET)
if(benchmark_FOUND)
  add_executable(stage_benchmarks ${CMAKE_CURRENT_LIST_DIR}/stage_benchmarks.cpp)
  target_link_libraries(stage_benchmarks PRIVATE
    depth_object_tracker_benchmark_support depth_object_tracker_warnings benchmark::benchmark)
else()
  message(STATUS "depth_object_tracker: without stage_benchmarks; Google Benchmark (libbenchmark-dev) was not found")
endif()

if(WITH_ROBOT)
  add_executable(kinematics_benchmark ${CMAKE_CURRENT_LIST_DIR}/kinematics_benchmark.cpp)
  target_link_libraries(kinematics_benchmark PRIVATE depth_object_tracker_robot depth_object_tracker_warnings)
  target_compile_definitions(kinematics_benchmark PRIVATE PROJECT_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}")
endif()

if(TARGET depth_object_tracker_robot AND TARGET depth_object_tracker_simulator)
  add_executable(robot_occluder_ablation
    ${CMAKE_CURRENT_LIST_DIR}/../sequence/occluder_trial.cpp
    ${CMAKE_CURRENT_LIST_DIR}/robot_occluder_ablation.cpp)
  target_link_libraries(robot_occluder_ablation PRIVATE
    depth_object_tracker_simulator depth_object_tracker_robot depth_object_tracker_warnings CLI11::CLI11)
  target_compile_definitions(robot_occluder_ablation PRIVATE PROJECT_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}")
  target_include_directories(robot_occluder_ablation PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../support)
endif()

if(WITH_ROS)
  set(benchmark_destination ${CATKIN_PACKAGE_BIN_DESTINATION})
else()
  set(benchmark_destination ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS engine_benchmark RUNTIME DESTINATION ${benchmark_destination})
if(WITH_ROBOT)
  install(TARGETS kinematics_benchmark RUNTIME DESTINATION ${benchmark_destination})
endif()
if(TARGET robot_occluder_ablation)
  install(TARGETS robot_occluder_ablation RUNTIME DESTINATION ${benchmark_destination})
endif()
if(benchmark_FOUND)
  install(TARGETS stage_benchmarks RUNTIME DESTINATION ${benchmark_destination})
endif()

if(BUILD_TESTS)
  # That it runs and covers the pixels it means to; how quick it is, is nobody's test.
  add_test(NAME engine_benchmark_runs COMMAND engine_benchmark --quick)
  set_tests_properties(engine_benchmark_runs PROPERTIES TIMEOUT 300)
endif()
