#include "acquire/logging.hpp"

#include <fmt/format.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace linescope {
namespace {

/// "<6>", syslog's number of the level.
class JournalLevel : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
    const std::string text = fmt::format("<{}>", number(message.level));
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<JournalLevel>(); }

 private:
  static int number(spdlog::level::level_enum level) {
    switch (level) {
      case spdlog::level::critical:
        return 2;
      case spdlog::level::err:
        return 3;
      case spdlog::level::warn:
        return 4;
      case spdlog::level::info:
        return 6;
      default:
        return 7;
    }
  }
};

spdlog::level::level_enum spdlog_level(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warning:
      return spdlog::level::warn;
    case LogLevel::error:
      break;
  }
  return spdlog::level::err;
}

bool journal_style(LogStyle style) {
  return style == LogStyle::journal || (style == LogStyle::automatic && journal_listens());
}

/// Known to log_refusal(): how standard error is written, and the file beside it.
struct Opened {
  bool journal = false;
  spdlog::sink_ptr file;
};
Opened& opened() {
  static Opened state;
  return state;
}

spdlog::sink_ptr standard_error(bool journal) {
  if (!journal) return std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<JournalLevel>('*').set_pattern("%*%v");
  sink->set_formatter(std::move(formatter));
  return sink;
}

/// The folder must be there: spdlog would make it, and a misspelt path would go unnoticed.
Result<spdlog::sink_ptr> file_sink(const std::filesystem::path& file) try {
  std::error_code error;
  if (!std::filesystem::is_directory(std::filesystem::absolute(file, error).parent_path(), error))
    return fail(ErrorCode::not_found, fmt::format("log file {} cannot be written: there is no folder {}",
                                                  file.string(), file.parent_path().string()));
  return std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string());
} catch (const spdlog::spdlog_ex&) {
  return fail(ErrorCode::permission,
              fmt::format("log file {} cannot be written: no permission, or it is a folder", file.string()));
}

}  // namespace

bool journal_listens() {
  // "device:inode" of the stream that systemd gave us; standard error may have been redirected since.
  const char* stream = std::getenv("JOURNAL_STREAM");
  struct stat here {};
  if (stream == nullptr || ::fstat(STDERR_FILENO, &here) != 0) return false;
  return fmt::format("{}:{}", here.st_dev, here.st_ino) == stream;
}

Result<void> open_log(const LogOptions& options) {
  opened() = {journal_style(options.style), nullptr};
  std::vector<spdlog::sink_ptr> sinks{standard_error(opened().journal)};
  if (!options.file.empty()) {
    auto file = file_sink(options.file);
    if (!file) return tl::unexpected(file.error());
    opened().file = *file;
    sinks.push_back(std::move(*file));
  }
  auto logger = std::make_shared<spdlog::logger>("linescope-acquire", sinks.begin(), sinks.end());
  logger->set_level(spdlog_level(options.level));
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
  return {};
}

void log_refusal(const Refusal& refusal) {
  std::fprintf(stderr, "%slinescope-acquire: %s\n", opened().journal ? "<3>" : "", refusal.message.c_str());
  if (!opened().file) return;
  spdlog::logger file("linescope-acquire", opened().file);
  file.error("{}", refusal.message);
  file.flush();
}

}  // namespace linescope
