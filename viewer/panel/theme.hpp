// The look of the panel: dark, calm, the same colours as the scene. Text and controls scale together.
#pragma once

#include <QColor>
#include <QPalette>
#include <QString>

#include "viewer/readouts.hpp"
#include "viewer/scene/palette.hpp"

namespace linescope {

QColor colour(const Rgb& rgb);
/// Of a state: never the only sign, a word or a mark stands beside it.
QColor colour(Mood mood);
/// The mark that goes with it: distinguishable in shape, too.
QString mark(Mood mood);

/// For the controls, drawn by Qt's Fusion style.
QPalette dark_palette();

/// Style sheet for everything; `scale` 1 is made for a 96 dpi screen at an arm's length.
QString style_sheet(double scale);

/// Size in pixels at the present scale.
int scaled(double pixels);
void set_panel_scale(double scale);
double panel_scale();

}  // namespace linescope
