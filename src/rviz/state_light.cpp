// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/rviz/state_light.h"

#include <QPainter>
#include <QRadialGradient>

namespace depth_object_tracker {

void StateLight::setColor(const QColor& color) {
  if (color == color_) return;
  color_ = color;
  update();
}

void StateLight::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF lamp(2.0, 2.0, width() - 4.0, height() - 4.0);
  QRadialGradient gradient(lamp.center() - QPointF(2.5, 3.0), 0.75 * lamp.width());
  gradient.setColorAt(0.0, color_.lighter(150));
  gradient.setColorAt(1.0, color_);
  painter.setBrush(gradient);
  painter.setPen(QPen(color_.darker(150), 1.2));
  painter.drawEllipse(lamp);
}

}  // namespace depth_object_tracker
