# The ROS 1 layer: messages, library, nodelets and nodes; and what is installed. BUILD_ROS=AUTO builds it where catkin is found.
set(ROS_COMPONENTS geometry_msgs image_transport message_generation nodelet pluginlib rosbag roscpp roslib sensor_msgs
  std_msgs std_srvs tf2_ros visualization_msgs)

# ros_find_python(): catkin's tools need a python3 that knows catkin_pkg; another one often stands first on the PATH.
function(ros_find_python)
  if(PYTHON_EXECUTABLE)
    return()
  endif()
  foreach(candidate python3 /usr/bin/python3)
    execute_process(COMMAND ${candidate} -c "import catkin_pkg" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(NOT failed)
      find_program(PYTHON_EXECUTABLE ${candidate} DOC "Python interpreter that knows catkin_pkg")
      return()
    endif()
  endforeach()
endfunction()

# ros_find_missing(RESULT): the packages of ROS_COMPONENTS that are not installed.
function(ros_find_missing result)
  set(missing)
  foreach(component catkin ${ROS_COMPONENTS})
    find_file(ROS_CONFIG_${component} ${component}Config.cmake
      PATHS ${CMAKE_PREFIX_PATH} /usr /opt/ros/noetic
      PATH_SUFFIXES share/${component}/cmake lib/cmake/${component} lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/${component})
    mark_as_advanced(ROS_CONFIG_${component})
    if(NOT ROS_CONFIG_${component})
      list(APPEND missing ${component})
    endif()
  endforeach()
  set(${result} "${missing}" PARENT_SCOPE)
endfunction()

set(WITH_ROS OFF)
if(BUILD_ROS STREQUAL "AUTO")
  ros_find_missing(ROS_MISSING)
  if(ROS_MISSING)
    string(REPLACE ";" " " ROS_MISSING "${ROS_MISSING}")
    message(STATUS "BUILD_ROS=AUTO: without the ROS layer; not found: ${ROS_MISSING}")
  else()
    message(STATUS "BUILD_ROS=AUTO: catkin found, with the ROS layer")
    set(WITH_ROS ON)
  endif()
elseif(BUILD_ROS)
  set(WITH_ROS ON)
else()
  message(STATUS "BUILD_ROS=${BUILD_ROS}: without the ROS layer")
endif()
if(NOT WITH_ROS)
  return()
endif()

ros_find_python()
find_package(catkin REQUIRED COMPONENTS ${ROS_COMPONENTS})
find_package(nlohmann_json REQUIRED)

add_message_files(DIRECTORY msg FILES Grasp.msg ParticleCloud.msg Slip.msg TrackerStatus.msg)
add_service_files(DIRECTORY srv FILES InitializeTracker.srv LoadObject.srv SetGrasp.srv)
generate_messages(DEPENDENCIES geometry_msgs std_msgs)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES depth_object_tracker_core depth_object_tracker_ros
  CATKIN_DEPENDS geometry_msgs image_transport message_runtime nodelet pluginlib rosbag roscpp roslib sensor_msgs std_msgs
    std_srvs tf2_ros visualization_msgs
  DEPENDS EIGEN3)

# Targets made before catkin was found go to the devel space too, where rosrun and pluginlib look.
get_property(EARLIER_TARGETS DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
set(ROS_INSTALL_LIBRARIES)
set(ROS_INSTALL_TARGETS)
foreach(target ${EARLIER_TARGETS})
  get_target_property(target_type ${target} TYPE)
  if(target_type STREQUAL "EXECUTABLE")
    set_target_properties(${target} PROPERTIES
      RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
    list(APPEND ROS_INSTALL_TARGETS ${target})
  elseif(target_type STREQUAL "SHARED_LIBRARY")
    set_target_properties(${target} PROPERTIES
      LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_LIB_DESTINATION})
    list(APPEND ROS_INSTALL_LIBRARIES ${target})
  endif()
endforeach()

add_library(depth_object_tracker_ros SHARED
  src/robot/twist_buffer.cpp
  src/ros/camera_conversions.cpp
  src/ros/camera_info_matcher.cpp
  src/ros/frame_inbox.cpp
  src/ros/image_conversions.cpp
  src/ros/initial_pose_resolver.cpp
  src/ros/marker_builder.cpp
  src/ros/message_conversions.cpp
  src/ros/object_source.cpp
  src/ros/overlay.cpp
  src/ros/parameter_loader.cpp
  src/ros/particle_messages.cpp
  src/ros/pose_validation.cpp
  src/ros/rate_meter.cpp
  src/ros/result_publisher.cpp
  src/ros/status_builder.cpp
  src/ros/tracker_nodelet.cpp
  src/ros/tracker_services.cpp
  src/ros/tracker_session.cpp
  src/ros/tracker_worker.cpp
)
target_include_directories(depth_object_tracker_ros PUBLIC include)
# SYSTEM: warnings in the headers of other packages are not ours to mend.
target_include_directories(depth_object_tracker_ros SYSTEM PUBLIC ${catkin_INCLUDE_DIRS} ${CATKIN_DEVEL_PREFIX}/include)
target_link_libraries(depth_object_tracker_ros
  PUBLIC depth_object_tracker_core ${catkin_LIBRARIES}
  PRIVATE depth_object_tracker_warnings nlohmann_json::nlohmann_json)
add_dependencies(depth_object_tracker_ros ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})

# The plugins, apart from the classes so that tests and plain nodes can link those.
add_library(depth_object_tracker_nodelets SHARED src/ros/tracker_plugin.cpp)
target_link_libraries(depth_object_tracker_nodelets PRIVATE depth_object_tracker_ros depth_object_tracker_warnings)

add_executable(tracker_node src/ros/tracker_node.cpp)
target_link_libraries(tracker_node PRIVATE depth_object_tracker_ros depth_object_tracker_warnings)

list(APPEND ROS_INSTALL_LIBRARIES depth_object_tracker_ros depth_object_tracker_nodelets)
list(APPEND ROS_INSTALL_TARGETS tracker_node)

# These add their sources to depth_object_tracker_nodelets and their programs to ROS_INSTALL_TARGETS.
include(cmake/ros_simulator.cmake OPTIONAL)
include(cmake/ros_tools.cmake OPTIONAL)

install(TARGETS ${ROS_INSTALL_LIBRARIES}
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
install(TARGETS ${ROS_INSTALL_TARGETS} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
foreach(folder config launch meshes rviz)
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${folder})
    install(DIRECTORY ${folder} DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
  endif()
endforeach()
