# Finds catkin where the ROS layer is wanted: WITH_ROS, messages, and the folders of the devel space. Adds no target of ours.
set(ROS_COMPONENTS bondcpp camera_info_manager diagnostic_msgs diagnostic_updater dynamic_reconfigure geometry_msgs image_transport
  interactive_markers kdl_parser message_filters message_generation nodelet pluginlib rosbag roscpp roslib sensor_msgs
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

add_message_files(DIRECTORY msg FILES Grasp.msg ParticleCloud.msg Slip.msg TrackerStatus.msg)
add_service_files(DIRECTORY srv FILES InitializeTracker.srv LoadObject.srv SetGrasp.srv)
generate_messages(DEPENDENCIES geometry_msgs std_msgs)
generate_dynamic_reconfigure_options(cfg/OpenNI2Camera.cfg cfg/TrackerLive.cfg)
# The .cfg file reads its defaults and ranges there.
add_custom_command(OUTPUT ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_INCLUDE_DESTINATION}/TrackerLiveConfig.h APPEND
  DEPENDS ${PROJECT_SOURCE_DIR}/config/tracker.yaml)


catkin_package(
  INCLUDE_DIRS include
  LIBRARIES depth_object_tracker_core depth_object_tracker_robot depth_object_tracker_ros
  CATKIN_DEPENDS bondcpp camera_info_manager diagnostic_msgs diagnostic_updater dynamic_reconfigure geometry_msgs image_transport
    interactive_markers kdl_parser message_filters message_runtime nodelet pluginlib rosbag roscpp roslib sensor_msgs std_msgs
    std_srvs tf2_ros visualization_msgs
  DEPENDS EIGEN3)
