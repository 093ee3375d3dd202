# depth_object_tracker_core: geometry, render, model, filter, tracker. Knows no ROS.
add_library(depth_object_tracker_core SHARED
  src/filter/depth_likelihood.cpp
  src/filter/gaussian6.cpp
  src/filter/informed_proposal.cpp
  src/filter/likelihood_climb.cpp
  src/filter/mixture_moments.cpp
  src/filter/mode_search.cpp
  src/filter/object_shape.cpp
  src/filter/occlusion_tiles.cpp
  src/filter/particle_filter.cpp
  src/filter/pose_assessment.cpp
  src/filter/pose_smoother.cpp
  src/filter/pose_statistics.cpp
  src/filter/random.cpp
  src/filter/resampling.cpp
  src/filter/score_scatter.cpp
  src/filter/tile_fit.cpp
  src/filter/tile_likelihood.cpp
  src/filter/worker_pool.cpp
  src/geometry/child_process.cpp
  src/geometry/convex_hull.cpp
  src/geometry/edge_collapse.cpp
  src/geometry/file_access.cpp
  src/geometry/isolated_mesh_loader.cpp
  src/geometry/level_of_detail.cpp
  src/geometry/mesh_file_check.cpp
  src/geometry/mesh_loader.cpp
  src/geometry/mesh_orientation.cpp
  src/geometry/mesh_parser.cpp
  src/geometry/mesh_reply.cpp
  src/geometry/mesh_uri.cpp
  src/geometry/pinhole_camera.cpp
  src/geometry/polygon_triangulation.cpp
  src/geometry/pose.cpp
  src/geometry/shape_meshes.cpp
  src/geometry/simd_target.cpp
  src/geometry/stable_poses.cpp
  src/geometry/surface_distance.cpp
  src/geometry/symmetry.cpp
  src/geometry/triangle_mesh.cpp
  src/model/measured_image.cpp
  src/model/occlusion_chain.cpp
  src/model/pixel_likelihood.cpp
  src/model/process_model.cpp
  src/model/slip_estimator.cpp
  src/render/depth_renderer.cpp
  src/render/depth_tile.cpp
  src/render/face_set.cpp
  src/render/render_levels.cpp
  src/render/tile_outline.cpp
  src/render/tile_rasterizer.cpp
  src/render/tile_renderer.cpp
  src/tracker/angle_belief.cpp
  src/tracker/distractors.cpp
  src/tracker/doubt.cpp
  src/tracker/estimate_board.cpp
  src/tracker/frame_budget.cpp
  src/tracker/frame_clock.cpp
  src/tracker/free_turn.cpp
  src/tracker/grasp_memory.cpp
  src/tracker/held_view.cpp
  src/tracker/illusions.cpp
  src/tracker/image_draws.cpp
  src/tracker/input_check.cpp
  src/tracker/live_parameters.cpp
  src/tracker/look_alike_check.cpp
  src/tracker/look_alikes.cpp
  src/tracker/nearest_name.cpp
  src/tracker/object_model.cpp
  src/tracker/object_tracker.cpp
  src/tracker/oriented_point_grid.cpp
  src/tracker/oriented_points.cpp
  src/tracker/other_objects.cpp
  src/tracker/pair_votes.cpp
  src/tracker/parameter_binding.cpp
  src/tracker/plane_finder.cpp
  src/tracker/point_pairs.cpp
  src/tracker/pose_evidence.cpp
  src/tracker/pose_finder.cpp
  src/tracker/pose_sampler.cpp
  src/tracker/pose_search.cpp
  src/tracker/reacquisition.cpp
  src/tracker/resolution.cpp
  src/tracker/screw_axis.cpp
  src/tracker/search_region.cpp
  src/tracker/sparse_fit.cpp
  src/tracker/status_monitor.cpp
  src/tracker/table_draws.cpp
  src/tracker/tracker_config_file.cpp
  src/tracker/tracker_parameters.cpp
  src/tracker/tracker_result.cpp
  src/tracker/tracking_frame.cpp
  src/tracker/tracking_held.cpp
  src/tracker/tracking_search.cpp
)
target_include_directories(depth_object_tracker_core
  # Headers that refuse to compile stand before the system's: a ROS include in the core is an error even where ROS lives in /usr/include.
  PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/cmake/no_ros ${CMAKE_CURRENT_SOURCE_DIR}/src
  PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
target_link_libraries(depth_object_tracker_core
  PUBLIC Eigen3::Eigen Threads::Threads
  PRIVATE depth_object_tracker_warnings assimp::assimp yaml-cpp ${CMAKE_DL_LIBS})

# Portable SIMD is optional: without Highway the plain C++ loops run, some ten times slower, with the same results.
find_path(HIGHWAY_INCLUDE_DIR hwy/highway.h)
find_library(HIGHWAY_LIBRARY hwy)
if(HIGHWAY_INCLUDE_DIR AND HIGHWAY_LIBRARY)
  target_sources(depth_object_tracker_core PRIVATE
    src/filter/tile_likelihood_simd.cpp
    src/render/tile_outline_simd.cpp
    src/render/tile_rasterizer_simd.cpp)
  target_compile_definitions(depth_object_tracker_core PRIVATE DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY)
  target_include_directories(depth_object_tracker_core SYSTEM PRIVATE ${HIGHWAY_INCLUDE_DIR})
  target_link_libraries(depth_object_tracker_core PRIVATE ${HIGHWAY_LIBRARY})
else()
  message(STATUS "depth_object_tracker: Highway (libhwy-dev) was not found: the tracker will be several times slower")
endif()

# Parses mesh files for the nodelets, in a process of its own. It finds nothing but its libraries.
add_executable(mesh_reader
  src/geometry/mesh_file_check.cpp
  src/geometry/mesh_parser.cpp
  src/geometry/mesh_reader.cpp
  src/geometry/mesh_reply.cpp
  src/geometry/polygon_triangulation.cpp
)
target_include_directories(mesh_reader PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/cmake/no_ros ${CMAKE_CURRENT_SOURCE_DIR}/include)
target_link_libraries(mesh_reader PRIVATE depth_object_tracker_warnings Eigen3::Eigen assimp::assimp)
precompile_headers(depth_object_tracker_core ${CORE_HEADERS})
count_lines(depth_object_tracker_core)
count_lines(mesh_reader)
