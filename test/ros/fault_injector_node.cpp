// SPDX-License-Identifier: BSD-3-Clause
// Stands between a camera and the tracker and spoils what comes through, as told on ~fault. Publishes the simulated
// time too, so that it can jump. After each image it tells on ~report: the fault, images received, images sent on.
#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>

#include <boost/make_shared.hpp>

#include <cstdlib>
#include <cstring>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <utility>

namespace {

struct Frame {
  sensor_msgs::Image image;
  sensor_msgs::CameraInfo info;
};

constexpr double kJumpS = 60.0;
constexpr std::size_t kDelayedFrames = 45;

/// Every second pixel of every second row.
void halveResolution(Frame& frame) {
  const sensor_msgs::Image full = frame.image;
  frame.image.width = full.width / 2;
  frame.image.height = full.height / 2;
  frame.image.step = 2 * frame.image.width;
  frame.image.data.resize(std::size_t{frame.image.step} * frame.image.height);
  for (std::uint32_t row = 0; row < frame.image.height; ++row) {
    for (std::uint32_t col = 0; col < frame.image.width; ++col) {
      std::memcpy(&frame.image.data[std::size_t{row} * frame.image.step + 2 * col],
                  &full.data[std::size_t{2 * row} * full.step + 4 * col], 2);
    }
  }
  frame.info.width = frame.image.width;
  frame.info.height = frame.image.height;
  for (const std::size_t k : {0u, 2u, 4u, 5u}) frame.info.K[k] *= 0.5;
  for (const std::size_t k : {0u, 2u, 5u, 6u}) frame.info.P[k] *= 0.5;
}

void convertToMetres(sensor_msgs::Image& image) {
  std::vector<float> depth_m(std::size_t{image.width} * image.height);
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    std::uint16_t mm;
    std::memcpy(&mm, &image.data[2 * i], 2);
    depth_m[i] = 0.001f * static_cast<float>(mm);
  }
  image.encoding = "32FC1";
  image.step = 4 * image.width;
  image.data.resize(4 * depth_m.size());
  std::memcpy(image.data.data(), depth_m.data(), image.data.size());
}

class FaultInjector {
 public:
  FaultInjector()
      : private_node_("~"),
        transport_(node_),
        camera_(transport_.advertiseCamera("faulty/depth/image_raw", 20)),
        clock_(node_.advertise<rosgraph_msgs::Clock>("/clock", 10)),
        report_(private_node_.advertise<std_msgs::String>("report", 100, true)),
        fault_subscriber_(private_node_.subscribe("fault", 10, &FaultInjector::onFault, this)),
        camera_subscriber_(transport_.subscribeCamera("camera/depth/image_raw", 20, &FaultInjector::onFrame, this)) {
    faults_ = {
        {"none", [this](Frame frame) { send(std::move(frame)); }},
        {"drop",
         [this](Frame frame) {
           if (num_received_ % 3 == 0) send(std::move(frame));
         }},
        {"delay", [this](Frame frame) { delay(std::move(frame)); }},
        {"duplicate", [this](Frame frame) { duplicate(std::move(frame)); }},
        {"reorder", [this](Frame frame) { reorder(std::move(frame)); }},
        {"truncate",
         [this](Frame frame) { frame.image.data.resize(frame.image.data.size() / 2), send(std::move(frame)); }},
        {"corrupt", [this](Frame frame) { corrupt(frame.image), send(std::move(frame)); }},
        {"resolution",
         [this](Frame frame) {
           if (num_received_ % 2 == 0) halveResolution(frame);
           send(std::move(frame));
         }},
        {"encoding", [this](Frame frame) { changeEncoding(frame.image), send(std::move(frame)); }},
        {"nan_intrinsics",
         [this](Frame frame) { frame.info.K.fill(std::numeric_limits<double>::quiet_NaN()), send(std::move(frame)); }},
        {"stop", [](const Frame&) {}},
    };
    report();
  }

 private:
  void onFault(const std_msgs::String& message) {
    if (message.data == "die") std::_Exit(1);
    if (message.data == "time_forward") offset_ += ros::Duration(kJumpS);
    if (message.data == "time_back") offset_ -= ros::Duration(kJumpS);
    fault_ = message.data;
    held_.clear();
    report();
  }

  void onFrame(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfoConstPtr& info) {
    ++num_received_;
    Frame frame{*image, *info};
    frame.image.header.stamp += offset_;
    frame.info.header.stamp += offset_;
    rosgraph_msgs::Clock clock;
    clock.clock = frame.image.header.stamp;
    clock_.publish(clock);
    const auto fault = faults_.find(fault_);
    (fault == faults_.end() ? faults_.at("none") : fault->second)(std::move(frame));
    report();
  }

  void send(Frame frame) {
    ++num_sent_;
    camera_.publish(boost::make_shared<sensor_msgs::Image>(std::move(frame.image)),
                    boost::make_shared<sensor_msgs::CameraInfo>(std::move(frame.info)));
  }

  void duplicate(Frame frame) {
    send(frame);
    ros::WallDuration(0.1).sleep();  // or the second overtakes the first
    send(std::move(frame));
  }

  void delay(Frame frame) {
    held_.push_back(std::move(frame));
    if (held_.size() <= kDelayedFrames) return;
    send(std::move(held_.front()));
    held_.pop_front();
  }

  /// The second of two goes first.
  void reorder(Frame frame) {
    held_.push_back(std::move(frame));
    if (held_.size() < 2) return;
    send(held_[1]);
    ros::WallDuration(0.1).sleep();  // or the tracker, which takes the newest to arrive, sees the other only
    send(held_[0]);
    held_.clear();
  }

  void corrupt(sensor_msgs::Image& image) {
    for (std::uint8_t& byte : image.data) {
      if (random_() % 3 == 0) byte = static_cast<std::uint8_t>(random_());
    }
  }

  void changeEncoding(sensor_msgs::Image& image) {
    if (num_received_ % 2 == 0) {
      image.encoding = "bgr8";
    } else {
      convertToMetres(image);
    }
  }

  void report() {
    std::ostringstream text;
    text << fault_ << ' ' << num_received_ << ' ' << num_sent_;
    std_msgs::String message;
    message.data = text.str();
    report_.publish(message);
  }

  ros::NodeHandle node_, private_node_;
  image_transport::ImageTransport transport_;
  image_transport::CameraPublisher camera_;
  ros::Publisher clock_, report_;
  ros::Subscriber fault_subscriber_;
  image_transport::CameraSubscriber camera_subscriber_;
  std::map<std::string, std::function<void(Frame)>> faults_;
  std::string fault_ = "none";
  ros::Duration offset_{0.0};
  std::deque<Frame> held_;
  std::uint64_t num_received_ = 0, num_sent_ = 0;
  std::mt19937 random_{1};
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "fault_injector");
  FaultInjector injector;
  ros::spin();
  return 0;
}
