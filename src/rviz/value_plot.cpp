// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/rviz/value_plot.h"

#include <QPainter>
#include <QPainterPath>

#include <algorithm>
#include <cmath>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr double kWindowS = 20.0;
constexpr double kGapS = 1.0;  // longer without a value: the curve is broken
constexpr int kTitleHeight = 18;
constexpr double kHeadroom = 1.08;

double secondsBetween(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

ValuePlot::ValuePlot(Style style, QWidget* parent) : QWidget(parent), style_(std::move(style)) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
}

void ValuePlot::add(double value) {
  const Clock::time_point now = Clock::now();
  samples_.push_back({now, value});
  while (secondsBetween(samples_.front().time, now) > kWindowS) samples_.pop_front();
  update();
}

void ValuePlot::clear() {
  samples_.clear();
  update();
}

double ValuePlot::top() const {
  double largest = style_.full_scale;
  for (const Sample& sample : samples_) {
    if (std::isfinite(sample.value)) largest = std::max(largest, sample.value);
  }
  return kHeadroom * largest;
}

void ValuePlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF area(0.5, kTitleHeight + 0.5, width() - 1.0, height() - kTitleHeight - 1.0);
  painter.fillRect(area, palette().color(QPalette::Base));
  painter.setPen(palette().color(QPalette::Mid));
  painter.drawRect(area);
  drawCurve(painter, area);
  drawText(painter);
}

void ValuePlot::drawCurve(QPainter& painter, const QRectF& area) const {
  const double highest = top();
  const auto height_of = [&](double value) {
    return area.bottom() - std::clamp(value / highest, 0.0, 1.0) * area.height();
  };
  if (style_.guide >= 0.0) {
    painter.setPen(QPen(palette().color(QPalette::Mid), 1.0, Qt::DashLine));
    painter.drawLine(QPointF(area.left(), height_of(style_.guide)), QPointF(area.right(), height_of(style_.guide)));
  }
  const Clock::time_point now = Clock::now();
  QPainterPath path;
  Clock::time_point last;
  bool is_drawing = false;
  for (const Sample& sample : samples_) {
    const QPointF point(area.right() - secondsBetween(sample.time, now) / kWindowS * area.width(),
                        height_of(sample.value));
    const bool is_gap = !std::isfinite(sample.value);
    const bool continues = is_drawing && secondsBetween(last, sample.time) < kGapS;
    if (!is_gap && continues) path.lineTo(point);
    if (!is_gap && !continues) path.moveTo(point);
    is_drawing = !is_gap;
    last = sample.time;
  }
  painter.setClipRect(area);
  painter.setPen(QPen(style_.color, 1.6));
  painter.drawPath(path);
  painter.setClipping(false);
}

void ValuePlot::drawText(QPainter& painter) const {
  const QRect line(2, 0, width() - 4, kTitleHeight);
  painter.setPen(palette().color(QPalette::WindowText));
  painter.drawText(line, Qt::AlignLeft | Qt::AlignVCenter, style_.title);
  const bool has_value = !samples_.empty() && std::isfinite(samples_.back().value);
  QFont bold = painter.font();
  bold.setBold(true);
  painter.setFont(bold);
  painter.drawText(line, Qt::AlignRight | Qt::AlignVCenter,
                   has_value ? style_.format(samples_.back().value) : QStringLiteral("–"));
}

}  // namespace depth_object_tracker
