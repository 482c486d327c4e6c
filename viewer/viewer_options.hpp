// The command line of linescope-viewer.
#pragma once

#include <string>
#include <variant>

#include "common/exit_code.hpp"
#include "viewer/navigation_worker.hpp"
#include "viewer/segment_feed.hpp"
#include "viewer/surface/mesher_options.hpp"

namespace linescope {

struct ViewerOptions {
  FeedOptions feed;
  MesherOptions mesher;
  NormalChoice normal = NormalChoice::robust;
  int width = 1280, height = 720;
  double font_scale = 1;
  double quit_after_s = 0;     ///< 0: never
  std::string screenshot;      ///< file, written before the end; empty: none
  std::string script;          ///< file with steps; empty: none
  std::string pictures = ".";  ///< folder for the pictures of a script
  std::string load;            ///< a session's folder or a mesh file: shown without any daemon; empty: none
  std::string sessions = ".";  ///< folder in which sessions are kept
  bool remember = true;        ///< settings from the last run, and for the next
  std::string state_json;      ///< file kept up to date with what is displayed; empty: none
};

/// First fault in one sentence.
Result<void> validate(const ViewerOptions& options);

/// What was printed instead of running (help, version).
struct Printed {
  std::string text;
};

/// The options; or what to print; or one sentence that says what is wrong.
/// `defaults`: what the command line does not say.
tl::expected<std::variant<ViewerOptions, Printed>, Refusal> read_viewer_options(
    int argc, const char* const* argv, const ViewerOptions& defaults = {});

}  // namespace linescope
