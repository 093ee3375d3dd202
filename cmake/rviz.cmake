# The rviz panel, where rviz's and Qt's development files are.
set(BUILD_RVIZ_PANEL AUTO CACHE STRING "Build the rviz panel: AUTO (when rviz and Qt are found), ON or OFF")
set_property(CACHE BUILD_RVIZ_PANEL PROPERTY STRINGS AUTO ON OFF)
set(WITH_RVIZ_PANEL OFF)
if(NOT WITH_ROS OR (NOT BUILD_RVIZ_PANEL AND NOT BUILD_RVIZ_PANEL STREQUAL "AUTO"))
  return()
endif()

find_package(rviz QUIET)
find_package(Qt5 QUIET COMPONENTS Core Gui Widgets)
# Only the library itself: what rviz's own package lists besides (OGRE's and OpenGL's) the panel does not use.
find_path(RVIZ_INCLUDE_DIR rviz/panel.h PATHS ${catkin_INCLUDE_DIRS})
find_library(RVIZ_LIBRARY rviz PATHS ${catkin_LIBRARY_DIRS})
mark_as_advanced(RVIZ_INCLUDE_DIR RVIZ_LIBRARY)
if(NOT rviz_FOUND OR NOT Qt5_FOUND OR NOT RVIZ_INCLUDE_DIR OR NOT RVIZ_LIBRARY)
  if(BUILD_RVIZ_PANEL STREQUAL "AUTO")
    message(STATUS "BUILD_RVIZ_PANEL=AUTO: without the rviz panel; it needs librviz-dev and qtbase5-dev")
    return()
  endif()
  message(FATAL_ERROR "BUILD_RVIZ_PANEL=ON, but rviz or Qt 5 was not found (Debian: librviz-dev, qtbase5-dev)")
endif()
set(WITH_RVIZ_PANEL ON)

add_library(depth_object_tracker_rviz SHARED
  include/depth_object_tracker/rviz/tracker_panel.h
  src/rviz/state_light.cpp
  src/rviz/tracker_panel.cpp
  src/rviz/tracker_panel_plugin.cpp
  src/rviz/value_plot.cpp
)
set_target_properties(depth_object_tracker_rviz PROPERTIES AUTOMOC ON)
# Qt's words "signals" and "slots" stand in the way of boost's.
target_compile_definitions(depth_object_tracker_rviz PRIVATE QT_NO_KEYWORDS)
target_include_directories(depth_object_tracker_rviz PUBLIC include)
target_include_directories(depth_object_tracker_rviz SYSTEM PRIVATE ${RVIZ_INCLUDE_DIR} ${catkin_INCLUDE_DIRS})
target_link_libraries(depth_object_tracker_rviz
  PUBLIC Qt5::Widgets ${RVIZ_LIBRARY} ${catkin_LIBRARIES}
  PRIVATE depth_object_tracker_warnings)
add_dependencies(depth_object_tracker_rviz ${${PROJECT_NAME}_EXPORTED_TARGETS})
