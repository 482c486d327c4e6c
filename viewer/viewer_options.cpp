#include "viewer/viewer_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "common/version.hpp"

namespace linescope {
namespace {

const std::map<std::string, MeshMethod> kMethods(kMeshMethodWords.begin(), kMeshMethodWords.end());
const std::map<std::string, NormalChoice> kNormals = {{"robust", NormalChoice::robust},
                                                      {"algorithm-1", NormalChoice::algorithm_1}};
const std::map<std::string, HeldIn> kHeld = {{"object", HeldIn::object}, {"world", HeldIn::world}};

template <class T>
CLI::Option* choice(CLI::App& app, const std::string& flag, T& into, const std::map<std::string, T>& names,
                    const std::string& help) {
  std::string all;
  for (const auto& [word, value] : names) all += (all.empty() ? "" : ", ") + word;
  return app
      .add_option_function<std::string>(
          flag,
          [&into, &names, flag, all](const std::string& word) {
            const auto found = names.find(word);
            if (found == names.end())
              throw CLI::ValidationError(flag, fmt::format("\"{}\" is none of {}", word, all));
            into = found->second;
          },
          help + " (" + all + ")")
      ->type_name("WHICH");
}

void declare_data(CLI::App& app, ViewerOptions& o) {
  app.add_option("-s,--segment", o.feed.segment, "Name of the daemon's segment")
      ->type_name("NAME")
      ->capture_default_str();
  choice(app, "--hold-in", o.feed.held_in, kHeld,
         "Frame the surface is held in: the object's sensor, or the tracker's");
  choice(app, "--mesher", o.mesher.method, kMethods,
         "How the surface is made; default implicit, the one-sided surface; pmc is the thesis's");
  app.add_option("--interval", o.mesher.interval, "Cubic interval t, mm")
      ->type_name("MM")
      ->capture_default_str();
  choice(app, "--normal", o.normal, kNormals, "How the surface normal is computed; default robust");
}

void declare_window(CLI::App& app, ViewerOptions& o) {
  app.add_option_function<std::string>(
         "--size",
         [&o](const std::string& text) {
           if (std::sscanf(text.c_str(), "%dx%d", &o.width, &o.height) != 2)
             throw CLI::ValidationError("--size", fmt::format("\"{}\" is not a size like 1280x720", text));
         },
         "Size of the window; default 1280x720")
      ->type_name("WxH");
  app.add_option("--font-scale", o.font_scale, "Size of text and controls, 1 is normal")->type_name("X");
  app.add_option(
         "--load", o.load,
         "Show a saved session (its folder) or a mesh file (.ply, .vtp, .stl, .obj), without any daemon")
      ->type_name("PATH");
  app.add_option("--sessions", o.sessions, "Folder in which sessions are kept (F3); default here")
      ->type_name("DIR");
  app.add_flag_callback(
      "--no-settings", [&o] { o.remember = false; },
      "Neither use what the last run remembered nor remember this one; scripts never do");
  app.add_option("--screenshot", o.screenshot, "Write a picture of the window before the end")
      ->type_name("FILE");
  app.add_option("--quit-after", o.quit_after_s, "End after this time")->type_name("SECONDS");
  app.add_option("--script", o.script, "Carry out the steps in a file, then end (docs/operators-guide.md)")
      ->type_name("FILE");
  app.add_option("--pictures", o.pictures, "Folder for the pictures of a script")->type_name("DIR");
  app.add_option("--state-json", o.state_json, "Keep what is displayed in a file, ten times a second")
      ->type_name("FILE");
}

}  // namespace

Result<void> validate(const ViewerOptions& o) {
  if (auto ok = validate(o.feed); !ok) return ok;
  if (auto ok = validate(o.mesher); !ok) return ok;
  if (o.width < 960 || o.height < 600 || o.width > 16384 || o.height > 16384)
    return fail(ErrorCode::usage,
                fmt::format("--size {}x{}: the window needs at least 960x600", o.width, o.height));
  if (!(o.font_scale >= 0.5 && o.font_scale <= 4))
    return fail(ErrorCode::usage, fmt::format("--font-scale {}: give a number from 0.5 to 4", o.font_scale));
  if (!(o.quit_after_s >= 0))
    return fail(ErrorCode::usage, fmt::format("--quit-after {}: give seconds", o.quit_after_s));
  return {};
}

tl::expected<std::variant<ViewerOptions, Printed>, Refusal> read_viewer_options(
    int argc, const char* const* argv, const ViewerOptions& defaults) {
  using Read = std::variant<ViewerOptions, Printed>;
  ViewerOptions options = defaults;
  CLI::App app(
      "linescope-viewer: shows the scanned surface and the harvester's angle to it. Not for clinical use.",
      "linescope-viewer");
  app.set_version_flag("--version", fmt::format("linescope-viewer {}", kVersion));
  declare_data(app, options);
  declare_window(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return Read(Printed{app.help()});
  } catch (const CLI::CallForVersion&) {
    return Read(Printed{app.version() + "\n"});
  } catch (const CLI::ParseError& error) {
    return tl::unexpected(
        Refusal{ExitCode::usage, fmt::format("{}; --help lists the options", error.what())});
  }
  if (auto ok = validate(options); !ok) return tl::unexpected(Refusal{ExitCode::usage, ok.error().message});
  return Read(options);
}

}  // namespace linescope
