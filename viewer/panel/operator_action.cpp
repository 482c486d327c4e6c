#include "viewer/panel/operator_action.hpp"

#include <algorithm>
#include <array>

namespace linescope {
namespace {

using A = OperatorAction;
constexpr std::array kActions = {
    ActionInfo{A::scan, "scan", "Space", "Start scanning, or stop it"},
    ActionInfo{A::clear, "clear", "C", "Throw the scan away"},
    ActionInfo{A::undo_sweep, "undo", "Backspace", "Take the last sweep back"},
    ActionInfo{A::surface, "surface", "2", "Surface: show and examine the surface"},
    ActionInfo{A::navigate, "navi", "3", "Navi: show the harvester against the normal"},
    ActionInfo{A::show_scan, "show-scan", "1", "Back to the scan without starting it"},
    ActionInfo{A::show_points, "points", "P", "Show the points"},
    ActionInfo{A::show_grid, "grid", "G", "Show the 3D grid"},
    ActionInfo{A::show_surface, "mesh", "S", "Show the surface"},
    ActionInfo{A::show_wireframe, "wireframe", "W", "Show the surface as a wireframe"},
    ActionInfo{A::normals, "normals", "N", "Shade with the surface normals, or flat"},
    ActionInfo{A::method, "method", "M", "Next method to make the surface"},
    ActionInfo{A::finer, "finer", "[", "Next smaller cubic interval"},
    ActionInfo{A::coarser, "coarser", "]", "Next larger cubic interval"},
    ActionInfo{A::close_holes, "close-holes", "O",
               "Close small holes of the one-sided surface, in another colour"},
    ActionInfo{A::layout_one, "layout-1", "F5", "One view"},
    ActionInfo{A::layout_one_and_three, "layout-1+3", "F6", "One view and three along the object's axes"},
    ActionInfo{A::layout_two_by_two, "layout-2x2", "F7", "Four views, one of them along the harvester"},
    ActionInfo{A::reset_view, "reset-view", "R", "Look from where the surface was scanned"},
    ActionInfo{A::follow_harvester, "follow", "H", "The free view follows the harvester, or stays"},
    ActionInfo{A::flip_harvester, "flip", "F", "Look along the harvester from its other end"},
    ActionInfo{A::turn_left, "left", "Left", "Turn the view: azimuth down"},
    ActionInfo{A::turn_right, "right", "Right", "Turn the view: azimuth up"},
    ActionInfo{A::turn_up, "up", "Up", "Turn the view: elevation up"},
    ActionInfo{A::turn_down, "down", "Down", "Turn the view: elevation down"},
    ActionInfo{A::roll_left, "roll-left", ",", "Roll the view counter-clockwise"},
    ActionInfo{A::roll_right, "roll-right", ".", "Roll the view clockwise"},
    ActionInfo{A::nearer, "nearer", "+", "Look from nearer"},
    ActionInfo{A::farther, "farther", "-", "Look from farther"},
    ActionInfo{A::measure, "measure", "D", "Measure a distance: click two points"},
    ActionInfo{A::region, "region", "A", "Evaluate all points, or a region: click its middle"},
    ActionInfo{A::next_shape, "next-shape", "T", "Next shape to evaluate: plane, cylinder, sphere"},
    ActionInfo{A::evaluate, "evaluate", "E", "Fit the shape and show what it leaves over"},
    ActionInfo{A::save_session, "save-session", "F3",
               "Save the session: mesh, points, evaluation, pictures, report"},
    ActionInfo{A::open_session, "open", "F4", "Open a saved session or a mesh file"},
    ActionInfo{A::live, "live", "L", "Leave the file and go back to the daemon"},
    ActionInfo{A::cancel, "cancel", "Esc", "Give up what takes long, or the measuring"},
    ActionInfo{A::save_picture, "save-picture", "F12", "Save a picture of the window"},
    ActionInfo{A::diagnostics, "diagnostics", "F2", "Diagnostics: latencies, counters, messages"},
    ActionInfo{A::shortcuts, "shortcuts", "F1", "This list"},
    ActionInfo{A::full_screen, "full-screen", "F11", "Full screen, or window"},
    ActionInfo{A::quit, "quit", "Ctrl+Q", "Close the viewer; the daemon goes on"},
};

}  // namespace

std::span<const ActionInfo> operator_actions() {
  return kActions;
}

const ActionInfo& info(OperatorAction action) {
  return *std::find_if(kActions.begin(), kActions.end(),
                       [&](const ActionInfo& i) { return i.action == action; });
}

std::optional<OperatorAction> action_by_id(const QString& id) {
  for (const ActionInfo& i : kActions)
    if (id == i.id) return i.action;
  return std::nullopt;
}

QString tooltip(OperatorAction action) {
  return QString("%1  (%2)").arg(info(action).text, info(action).key);
}

}  // namespace linescope
