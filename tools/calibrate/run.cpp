#include "tools/calibrate/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "common/camera_file.hpp"
#include "common/config_schema.hpp"
#include "tools/calibrate/content_hash.hpp"
#include "tools/calibrate/inputs.hpp"
#include "tools/calibrate/record_entry.hpp"
#include "tools/calibrate/segment_input.hpp"
#include "tools/calibrate/text.hpp"

namespace linescope::calibrate {
namespace {

namespace fs = std::filesystem;

Exit complain(Exit code, const std::string& message) {
  fmt::print(stderr, "linescope-calibrate: {}\n", message);
  return code;
}

Exit exit_for(const Error& error) {
  if (is_refusal(error)) return kRefused;
  return error.code == ErrorCode::not_found || error.code == ErrorCode::gone ? kInput : kFailed;
}

void declare(ConfigSchema& schema, BoardOptions& board) {
  schema.section("board", "The calibration board.");
  schema.choice("board.kind", board.kind,
                {{"chessboard", BoardKind::chessboard}, {"charuco", BoardKind::charuco}}, "What it shows.");
  schema.integer("board.corners_x", board.corners_x, {.min = 3, .max = 64},
                 "Inner corners along the longer side.");
  schema.integer("board.corners_y", board.corners_y, {.min = 3, .max = 64},
                 "Inner corners along the other side.");
  schema.number("board.square_mm", board.square_mm, {.unit = "mm", .min = 0.1, .max = 1000},
                "Side of a square, measured on the print.");
  schema.number("board.marker_mm", board.marker_mm, {.unit = "mm", .min = 0.05, .max = 1000},
                "ChArUco: side of a marker.");
  schema.text("board.dictionary", board.dictionary, "ChArUco: OpenCV's dictionary, for example 4x4_50.");
}

bool there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

/// What the values are before anything was calibrated.
Calibration fresh() {
  Calibration c = thesis_camera_ii();
  c.name = "calibrated by linescope-calibrate";
  c.notes.clear();
  return c;
}

class Runner {
 public:
  explicit Runner(const Command& command) : command_(command), steps_(all_steps()) {
    declare(schema_, board_);
    for (const auto& step : steps_) step->declare(schema_);
  }

  Exit run() {
    if (const Exit code = configure(); code != kOk) return code;
    if (command_.print_config) return fmt::print("{}", schema_.to_toml()), kOk;
    if (command_.print_keys) return fmt::print("{}", schema_.to_markdown()), kOk;
    const auto step =
        std::find_if(steps_.begin(), steps_.end(), [&](const auto& s) { return s->name() == command_.step; });
    if (step == steps_.end()) return complain(kUsage, fmt::format("{} is no step", command_.step));
    return calibrate(**step);
  }

 private:
  Exit configure() {
    if (!command_.config.empty()) {
      const auto faults = schema_.read_file(command_.config);
      for (const ConfigFault& fault : faults) complain(kConfiguration, fault.message);
      if (!faults.empty()) return kConfiguration;
    }
    for (const std::string& assignment : command_.assignments)
      if (auto ok = schema_.set(assignment); !ok) return complain(kUsage, ok.error().message);
    if (auto ok = validate(board_); !ok) return complain(kConfiguration, ok.error().message);
    for (const auto& step : steps_)
      if (auto ok = step->validate(); !ok) return complain(kConfiguration, ok.error().message);
    return kOk;
  }

  Result<Calibration> before() const {
    return there(command_.calibration) ? load_calibration(command_.calibration)
                                       : Result<Calibration>(fresh());
  }

  Result<Session> collected(const Step& step) const {
    const bool live = command_.from.empty();
    auto input = live ? input_from_segment(command_.segment) : input_from_path(command_.from);
    if (!input) return tl::unexpected(input.error());
    CollectOptions wanted = step.wants(board_);
    // A folder is a choice somebody has made; of a stream only some pictures are looked at.
    const bool chosen = !input->calibration && !live && fs::is_directory(command_.from);
    if (chosen) wanted.every = 0, wanted.most_pictures = 0;
    if (live) wanted.longest = nanoseconds_from_seconds(command_.seconds);
    Nanoseconds told = 0;
    const auto progress = [&](const Session& so_far, const Frame&) {
      if (monotonic_now() - told < kSecond / 2) return true;
      told = monotonic_now();
      fmt::print(stderr, "\r{}: {}\x1b[K", step.name(), step.coverage(so_far, board_));
      return true;
    };
    auto session = collect(*input, wanted, progress);
    if (told != 0) fmt::print(stderr, "\n");
    return session;
  }

  Exit calibrate(const Step& step) const {
    const auto old = before();
    if (!old) return complain(kCalibration, old.error().message);
    const auto session = collected(step);
    if (!session) return complain(exit_for(session.error()), session.error().message);
    auto outcome = step.run(*session, board_, *old);
    if (!outcome)
      return complain(exit_for(outcome.error()), fmt::format("{}: {}", step.name(), outcome.error().message));
    fmt::print("{}, {}\n{}", step.name(), outcome->method, as_text(outcome->quality));
    if (auto ok = write_plots(outcome->plots); !ok) return complain(kFailed, ok.error().message);
    if (outcome->refused)
      return complain(kRefused, fmt::format("{}: not stored: {}", step.name(), outcome->refused->message));
    return keep(step, *session, *outcome);
  }

  Exit keep(const Step& step, const Session& session, const Outcome& outcome) const {
    if (!outcome.put) return fmt::print("verdict: good\n"), kOk;
    if (command_.dry_run) return fmt::print("verdict: good; not stored (--dry-run)\n"), kOk;
    Entry entry = make_entry(std::string(step.name()), session.description, session.hash, outcome.method,
                             outcome.quality);
    if (auto ok = store(command_.calibration, fresh(), std::move(entry), outcome.put); !ok)
      return complain(kCalibration, ok.error().message);
    fmt::print("verdict: good; stored in {}\n", command_.calibration.string());
    return kOk;
  }

  Result<void> write_plots(const std::vector<Plot>& plots) const {
    if (command_.plots.empty()) return {};
    std::error_code error;
    fs::create_directories(command_.plots, error);
    for (const Plot& plot : plots) {
      const fs::path file = command_.plots / (plot.name + ".png");
      bool written = false;
      try {
        written = cv::imwrite(file.string(), plot.picture);
      } catch (const cv::Exception&) {
        written = false;
      }
      if (!written)
        return fail(ErrorCode::permission, fmt::format("{}: cannot be written there", file.string()));
    }
    return {};
  }

  const Command& command_;
  BoardOptions board_;
  ConfigSchema schema_;
  std::vector<std::unique_ptr<Step>> steps_;
};

Exit show(const fs::path& file) {
  const auto calibration = load_calibration(file);
  if (!calibration) return complain(kCalibration, calibration.error().message);
  const auto entries = read_entries(file);
  if (!entries) return complain(kCalibration, entries.error().message);
  fmt::print("{}", as_text(*calibration, *entries));
  return kOk;
}

/// Intrinsics that somebody else has found.
Exit import(const Command& command) {
  const auto camera = load_camera(command.file.string());
  if (!camera) return complain(kCalibration, camera.error().message);
  ContentHash hash;
  hash.add(&*camera, sizeof *camera);
  Entry entry = make_entry("camera", command.file.filename().string(), hash.value(), "imported", {});
  const auto put = [&](Calibration& c) {
    std::string previous = fmt::format("f {:.3f} {:.3f}", c.camera.fx, c.camera.fy);
    c.camera = *camera;
    return previous;
  };
  if (auto ok = store(command.calibration, fresh(), std::move(entry), put); !ok)
    return complain(kCalibration, ok.error().message);
  fmt::print("camera of {} stored in {}\n", command.file.string(), command.calibration.string());
  return kOk;
}

}  // namespace

Exit run(const Command& command) {
  if (command.step == "show") return show(command.file);
  if (command.step == "import") return import(command);
  return Runner(command).run();
}

}  // namespace linescope::calibrate
