// A scan that was kept: a folder with files other programs read, from which the viewer shows it again without
// any daemon.
//
//   session.toml        what this is, by which program, frame, unit, how the surface was made
//   surface.ply         the mesh, frame and unit in its comment (absent while there is none)
//   points.csv          line, x_mm, y_mm, z_mm, deviation_mm, intensity
//   lines.csv           line, time_ns, seen_from_x_mm, _y_mm, _z_mm
//   evaluation.csv      one row per evaluation, figures in mm
//   configuration.toml, calibration.yaml   as the daemon said
//   diagnostics.txt     the pages of the diagnostics
//   pictures/*.png      the window in its three moments
//   report.html         all of it for people; says that it is not for clinical use
//
// Coordinates are millimetres in the frame the surface is held in. The folder is complete or not there: it is
// written beside its place and then moved. Nothing about a patient is asked for or written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "viewer/background_job.hpp"
#include "viewer/measure/shape_evaluation.hpp"
#include "viewer/surface/mesher_options.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

struct Session {
  std::string name;   ///< of the folder or file it came from; empty for one that is not saved yet
  std::string saved;  ///< ISO 8601, local time
  std::string program;
  HeldIn held_in = HeldIn::object;
  HeldLines lines;
  std::shared_ptr<const TriangleMesh> mesh;  ///< null: none
  MesherOptions mesher;
  std::string method;  ///< for people
  std::vector<ShapeEvaluation> evaluations;
  std::vector<double> distances;  ///< measured by the operator, mm
  std::string daemon;             ///< program and version that measured it
  std::string configuration, calibration, diagnostics;

  std::size_t point_count() const;
};

/// `folder` must not exist. `pictures`: PNG files with their names, written already; they are moved into the
/// session. Refused with a sentence; given up (ErrorCode::gone) when `control` says so: nothing is left then.
Result<void> save_session(const Session& session, const std::filesystem::path& folder,
                          const std::vector<std::filesystem::path>& pictures, JobControl& control);

/// A session's folder, its session.toml, or a mesh file alone (no points then).
Result<Session> load_session(const std::filesystem::path& path, JobControl& control);

/// report.html as text.
std::string session_report(const Session& session, const std::vector<std::string>& picture_names);

}  // namespace linescope
