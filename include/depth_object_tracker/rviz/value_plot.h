// SPDX-License-Identifier: BSD-3-Clause
// One figure over the last seconds, as a small curve with its name and newest value.
#pragma once

#include <QColor>
#include <QString>
#include <QWidget>

#include <chrono>
#include <deque>
#include <functional>

namespace depth_object_tracker {

/// Used by the GUI's thread alone.
class ValuePlot : public QWidget {
 public:
  struct Style {
    QString title;
    QColor color;
    double full_scale = 1.0;  ///< the axis ends here; values beyond stretch it
    double guide = -1.0;      ///< a dashed line; negative = none
    std::function<QString(double)> format;
  };

  explicit ValuePlot(Style style, QWidget* parent = nullptr);

  /// @param value not finite: a gap in the curve.
  void add(double value);
  void clear();

  QSize sizeHint() const override { return {220, 64}; }
  QSize minimumSizeHint() const override { return {120, 52}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Sample {
    Clock::time_point time;
    double value;
  };

  double top() const;
  void drawCurve(QPainter& painter, const QRectF& area) const;
  void drawText(QPainter& painter) const;

  Style style_;
  std::deque<Sample> samples_;
};

}  // namespace depth_object_tracker
