# Real time: what a frame may ask of the heap, and how much work it may be.
add_tracker_test(worst_case_test
  SOURCES real_time/worst_case_test.cpp sequence/scripted_scene.cpp
  LIBRARIES depth_object_tracker_simulator depth_object_tracker_tools)

if(NOT SANITIZE)  # sanitizers bring their own malloc
  add_tracker_test(frame_allocations_test
    SOURCES real_time/allocation_watch.cpp real_time/frame_allocations_test.cpp sequence/scripted_scene.cpp
    LIBRARIES depth_object_tracker_simulator depth_object_tracker_tools)
endif()
