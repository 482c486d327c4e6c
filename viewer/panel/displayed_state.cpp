#include "viewer/panel/displayed_state.hpp"

#include <fmt/format.h>

#include <QJsonDocument>
#include <QSaveFile>

namespace linescope {

Result<void> write_displayed_state(const QJsonObject& state, const QString& file) {
  QSaveFile out(file);
  const QByteArray text = QJsonDocument(state).toJson();
  if (!out.open(QIODevice::WriteOnly) || out.write(text) != text.size() || !out.commit())
    return fail(ErrorCode::unreadable,
                fmt::format("{} cannot be written: {}; give --state-json a file in a folder that "
                            "exists and is writable",
                            file.toStdString(), out.errorString().toStdString()));
  return {};
}

}  // namespace linescope
