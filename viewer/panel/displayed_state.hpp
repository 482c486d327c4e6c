// What the window says at this moment, for scripts and tests: the texts as shown, not the values behind them.
#pragma once

#include <QJsonObject>
#include <QString>

#include "common/result.hpp"

namespace linescope {

/// Writes the object to `file`, which is complete at every moment.
Result<void> write_displayed_state(const QJsonObject& state, const QString& file);

}  // namespace linescope
