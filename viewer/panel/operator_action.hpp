// Everything the operator can do, in one table: buttons, keys (and foot pedals, which are keys), the list on
// F1 and scripts are made from it.
#pragma once

#include <QString>
#include <optional>
#include <span>

namespace linescope {

enum class OperatorAction : std::uint8_t {
  scan,  ///< start; or stop, when it is running
  clear,
  undo_sweep,
  surface,
  navigate,
  show_scan,
  show_points,
  show_grid,
  show_surface,
  show_wireframe,
  normals,
  method,
  finer,
  coarser,
  close_holes,
  layout_one,
  layout_one_and_three,
  layout_two_by_two,
  reset_view,
  follow_harvester,
  flip_harvester,
  turn_left,
  turn_right,
  turn_up,
  turn_down,
  roll_left,
  roll_right,
  nearer,
  farther,
  measure,
  region,
  next_shape,
  evaluate,
  save_session,
  open_session,
  live,
  cancel,
  save_picture,
  diagnostics,
  shortcuts,
  full_screen,
  quit,
};

struct ActionInfo {
  OperatorAction action;
  const char* id;    ///< in scripts
  const char* key;   ///< as QKeySequence reads it
  const char* text;  ///< what it does
};

std::span<const ActionInfo> operator_actions();
const ActionInfo& info(OperatorAction action);
std::optional<OperatorAction> action_by_id(const QString& id);

/// "what it does (key)"
QString tooltip(OperatorAction action);

}  // namespace linescope
