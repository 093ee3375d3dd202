# Tests of the OpenNI2 camera; know no ROS. The virtual device is a driver that OpenNI2 loads, in a mount namespace of the test.
if(NOT TARGET depth_object_tracker_camera)
  return()
endif()

add_tracker_test(camera_test
  SOURCES camera/device_clock_test.cpp camera/depth_frame_test.cpp camera/device_finder_test.cpp
  LIBRARIES depth_object_tracker_camera GTest::gmock)
target_include_directories(camera_test PRIVATE ${PROJECT_SOURCE_DIR}/src)

add_library(virtual_depth_driver MODULE camera/virtual_depth_driver.cpp)
target_include_directories(virtual_depth_driver SYSTEM PRIVATE ${OPENNI2_INCLUDE_DIR})
target_link_libraries(virtual_depth_driver PRIVATE depth_object_tracker_core depth_object_tracker_warnings)
target_compile_definitions(virtual_depth_driver PRIVATE PROJECT_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}")
set_target_properties(virtual_depth_driver PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
set(WITH_VIRTUAL_DEVICE ${CMAKE_CURRENT_SOURCE_DIR}/camera/with_virtual_device $<TARGET_FILE:virtual_depth_driver>)

add_executable(depth_camera_test camera/depth_camera_test.cpp)
target_include_directories(depth_camera_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/support)
target_include_directories(depth_camera_test SYSTEM PRIVATE ${OPENNI2_INCLUDE_DIR})
target_link_libraries(depth_camera_test PRIVATE depth_object_tracker_core depth_object_tracker_camera
  depth_object_tracker_warnings ${OPENNI2_LIBRARY} GTest::gmock GTest::gtest_main)
target_compile_definitions(depth_camera_test PRIVATE PROJECT_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}")
if(SANITIZE)
  target_sources(depth_camera_test PRIVATE sanitizers/keep_libraries.cpp)
  set_target_properties(depth_camera_test PROPERTIES ENABLE_EXPORTS ON)
endif()
add_dependencies(depth_camera_test virtual_depth_driver)
add_test(NAME depth_camera_test COMMAND ${WITH_VIRTUAL_DEVICE} $<TARGET_FILE:depth_camera_test>)
set_tests_properties(depth_camera_test PROPERTIES TIMEOUT ${TEST_TIMEOUT_S} SKIP_RETURN_CODE 77)

if(NOT TARGET depth_object_tracker_ros_camera OR NOT ROSTEST_PROGRAM)
  return()
endif()

add_executable(openni2_camera_rostest camera/openni2_camera_rostest.cpp)
target_include_directories(openni2_camera_rostest PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/ros ${CMAKE_CURRENT_SOURCE_DIR}/support)
target_include_directories(openni2_camera_rostest SYSTEM PRIVATE ${OPENNI2_INCLUDE_DIR})
target_link_libraries(openni2_camera_rostest PRIVATE depth_object_tracker_ros_camera depth_object_tracker_warnings
  ${OPENNI2_LIBRARY} GTest::gtest)
target_compile_definitions(openni2_camera_rostest PRIVATE PROJECT_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}")
if(SANITIZE)
  target_sources(openni2_camera_rostest PRIVATE sanitizers/keep_libraries.cpp)
  set_target_properties(openni2_camera_rostest PROPERTIES ENABLE_EXPORTS ON)
endif()
add_dependencies(openni2_camera_rostest virtual_depth_driver depth_object_tracker_nodelets
  depth_object_tracker_camera_nodelets)

# add_virtual_camera_test(NAME): NAME.test with a master of its own, where OpenNI2 finds the virtual device.
function(add_virtual_camera_test name)
  add_test(NAME ${name}
    COMMAND ${WITH_VIRTUAL_DEVICE} ${CATKIN_DEVEL_PREFIX}/env.sh rostest ${CMAKE_CURRENT_SOURCE_DIR}/camera/${name}.test)
  # Alone: the tracker has to keep up with a camera that waits for nobody.
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 RUN_SERIAL TRUE)
  set_ros_test(${name} 600)
endfunction()

add_virtual_camera_test(openni2_live_rostest)
add_virtual_camera_test(openni2_recording_rostest)
