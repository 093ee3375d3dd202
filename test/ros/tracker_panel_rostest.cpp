// SPDX-License-Identifier: BSD-3-Clause
// The rviz panel's buttons, pressed, act on a running tracker, and its lamp and words follow. No display is needed.
#include <gtest/gtest.h>

#include "depth_object_tracker/rviz/state_light.h"
#include "depth_object_tracker/rviz/tracker_panel.h"

#include "tracker_harness.h"

#include <ros/ros.h>

#include <QApplication>
#include <QLabel>
#include <QPushButton>

namespace depth_object_tracker {
namespace {

const char* const kName = "/tracker_panel";

class TrackerPanelTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { setGoodParameters(kName); }

  TrackerPanelTest() : tracker_(kName) { panel_.setTracker(kName); }

  QString text(const char* label) const { return panel_.findChild<QLabel*>(label)->text(); }
  QPushButton* button(const char* name) const { return panel_.findChild<QPushButton*>(name); }

  /// Lets the panel work until it says so.
  bool waitForText(const char* label, const QString& part) {
    return waitUntil([&] {
      QApplication::processEvents();
      return text(label).contains(part);
    });
  }

  TrackerHarness tracker_;
  TrackerPanel panel_;
};

TEST_F(TrackerPanelTest, ButtonsActAndTheLampFollows) {
  ASSERT_TRUE(tracker_.isReady());
  const auto* light = panel_.findChild<QWidget*>("light");
  ASSERT_NE(light, nullptr);
  EXPECT_TRUE(waitForText("state", "UNINITIALIZED"));
  EXPECT_TRUE(waitForText("reason", "no initial pose"));

  button("initialise")->click();
  EXPECT_TRUE(waitForText("answer", "not shown")) << text("answer").toStdString();

  ASSERT_TRUE(tracker_.initialise());
  tracker_.expectTracking();
  EXPECT_TRUE(waitForText("state", "TRACKING"));
  EXPECT_EQ(text("reason"), "");
  const QColor green = static_cast<const StateLight*>(light)->color();
  EXPECT_GT(green.green(), green.red());

  button("pause")->click();
  EXPECT_TRUE(waitForText("state", "PAUSED"));
  EXPECT_EQ(button("pause")->text(), "Resume");
  EXPECT_TRUE(waitForText("answer", "paused"));
  button("pause")->click();
  EXPECT_TRUE(waitForText("answer", "running"));
  tracker_.expectTracking();
  EXPECT_TRUE(waitForText("state", "TRACKING"));

  button("reset")->click();
  EXPECT_TRUE(waitForText("state", "UNINITIALIZED"));
  EXPECT_TRUE(waitForText("answer", "reset"));
  tracker_.step();
  // The marker stands where the object was.
  button("initialise")->click();
  EXPECT_TRUE(waitForText("answer", "accepted")) << text("answer").toStdString();
  tracker_.expectTracking();
  EXPECT_TRUE(waitForText("state", "TRACKING"));
}

TEST_F(TrackerPanelTest, SaysWhenThereIsNoTracker) {
  panel_.setTracker("/nobody");
  EXPECT_TRUE(text("state").contains("NO STATUS"));
  EXPECT_TRUE(text("reason").contains("/nobody/status"));
  button("reset")->click();
  EXPECT_TRUE(waitForText("answer", "no such service"));
  panel_.setTracker("not a name!");
  EXPECT_TRUE(text("reason").contains("is no name"));
}

TEST_F(TrackerPanelTest, RemembersItsTracker) {
  rviz::Config config;
  panel_.save(config);
  TrackerPanel other;
  other.load(config);
  QString name;
  rviz::Config saved;
  other.save(saved);
  EXPECT_TRUE(saved.mapGetString("Tracker", &name));
  EXPECT_EQ(name, kName);
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "tracker_panel_rostest");
  ros::NodeHandle node;
  ros::AsyncSpinner spinner(2);
  spinner.start();
  qputenv("QT_QPA_PLATFORM", "offscreen");
  QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
