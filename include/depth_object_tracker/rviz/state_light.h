// SPDX-License-Identifier: BSD-3-Clause
// A lamp in the colour of the tracker's state.
#pragma once

#include <QColor>
#include <QWidget>

namespace depth_object_tracker {

class StateLight : public QWidget {
 public:
  explicit StateLight(QWidget* parent = nullptr) : QWidget(parent) { setFixedSize(22, 22); }

  void setColor(const QColor& color);
  const QColor& color() const { return color_; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QColor color_ = Qt::gray;
};

}  // namespace depth_object_tracker
