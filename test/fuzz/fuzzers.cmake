# Fuzz targets for clang's libFuzzer; scripts/fuzz builds and runs them. Each compiles its own copy of the code that it tries.
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "BUILD_FUZZERS needs clang: -DCMAKE_CXX_COMPILER=clang++ (scripts/fuzz does so)")
endif()
set(FUZZ_FLAGS -fsanitize=address,undefined -fno-sanitize-recover=all -fprofile-instr-generate -fcoverage-mapping)
add_custom_target(fuzzers)
# Only ever computes a proposal for a message, from all names against all letters: most of the time, if every step is watched.
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/tracker/nearest_name.cpp PROPERTIES COMPILE_OPTIONS "-fno-sanitize=fuzzer;-O2")

# add_fuzzer(NAME COVERED source... [ALSO source...] [LIBRARIES ...]): NAME_fuzzer from NAME_fuzzer.cpp; the share of COVERED that
# it reaches is counted.
function(add_fuzzer name)
  cmake_parse_arguments(ARG "" "" "COVERED;ALSO;LIBRARIES" ${ARGN})
  list(TRANSFORM ARG_COVERED PREPEND ${PROJECT_SOURCE_DIR}/src/)
  list(TRANSFORM ARG_ALSO PREPEND ${PROJECT_SOURCE_DIR}/src/)
  add_executable(${name}_fuzzer EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/test/fuzz/${name}_fuzzer.cpp ${ARG_COVERED} ${ARG_ALSO})
  target_include_directories(${name}_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_compile_options(${name}_fuzzer PRIVATE ${FUZZ_FLAGS} -fsanitize=fuzzer -O1 -g1)
  target_link_options(${name}_fuzzer PRIVATE ${FUZZ_FLAGS} -fsanitize=fuzzer)
  target_link_libraries(${name}_fuzzer PRIVATE Eigen3::Eigen ${ARG_LIBRARIES})
  set_target_properties(${name}_fuzzer PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/fuzzers)
  string(REPLACE ";" "\n" covered "${ARG_COVERED}")
  string(REPLACE "${PROJECT_SOURCE_DIR}/" "/" covered "${covered}")  # compilers may name files relative to the build
  file(WRITE ${CMAKE_BINARY_DIR}/fuzzers/${name}.covered "${covered}\n")
  add_dependencies(fuzzers ${name}_fuzzer)
endfunction()

add_fuzzer(mesh
  COVERED geometry/mesh_file_check.cpp geometry/mesh_parser.cpp geometry/mesh_reply.cpp geometry/polygon_triangulation.cpp
  LIBRARIES assimp::assimp)
add_fuzzer(mesh_reply COVERED geometry/mesh_reply.cpp)
add_fuzzer(yaml
  COVERED tracker/object_model.cpp tracker/parameter_binding.cpp tracker/tracker_config_file.cpp tracker/tracker_parameters.cpp
  ALSO geometry/file_access.cpp geometry/mesh_file_check.cpp geometry/mesh_loader.cpp geometry/mesh_parser.cpp
    geometry/mesh_uri.cpp geometry/polygon_triangulation.cpp geometry/triangle_mesh.cpp tracker/nearest_name.cpp
  LIBRARIES assimp::assimp yaml-cpp)
add_fuzzer(bop
  COVERED tools/bop_models_info.cpp tools/bop_scene.cpp tools/depth_picture.cpp tools/json_file.cpp tools/visibility_file.cpp
  ALSO geometry/pinhole_camera.cpp
  LIBRARIES nlohmann_json::nlohmann_json opencv_core opencv_imgcodecs)
if(WITH_ROS)
  add_fuzzer(image
    COVERED ros/camera_conversions.cpp ros/image_conversions.cpp geometry/pinhole_camera.cpp
    LIBRARIES ${catkin_LIBRARIES})
  add_fuzzer(robot
    COVERED robot/joint_state_buffer.cpp robot/link_chain.cpp robot/link_meshes.cpp robot/robot_model.cpp robot/robot_state.cpp
    ALSO geometry/file_access.cpp geometry/mesh_file_check.cpp geometry/mesh_loader.cpp geometry/mesh_parser.cpp
      geometry/mesh_uri.cpp geometry/polygon_triangulation.cpp geometry/pose.cpp geometry/shape_meshes.cpp
      geometry/triangle_mesh.cpp robot/arm_solver.cpp
    LIBRARIES assimp::assimp ${urdfdom_LIBRARIES} ${orocos_kdl_LIBRARIES} ${KDL_PARSER_LIBRARY} ${catkin_LIBRARIES})
  target_include_directories(robot_fuzzer SYSTEM PRIVATE
    ${urdfdom_headers_INCLUDE_DIRS} ${urdfdom_INCLUDE_DIRS} ${orocos_kdl_INCLUDE_DIRS} ${KDL_PARSER_INCLUDE_DIR})
endif()
