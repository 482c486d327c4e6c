// A writer of a segment under the test's control: three tools, lines on a flat board, commands counted.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/calibration.hpp"
#include "ipc/control.hpp"
#include "ipc/heartbeat.hpp"
#include "ipc/segment_writer.hpp"

namespace linescope::testing {

/// Object and endoscope stand still. In the object's frame the board is the plane z = 0, seen from above; the
/// object itself is moved and turned in the world, so that frames cannot be mixed up unnoticed.
class FakeDaemon {
 public:
  explicit FakeDaemon(const std::string& segment, std::uint32_t point_capacity = 2'000'000)
      : segment_(segment) {
    SegmentOptions options;
    options.name = segment;
    options.point_capacity = point_capacity;
    options.program = "fake daemon";
    writer_.emplace(std::move(SegmentWriter::create(options).value()));
    heartbeat_ = std::make_unique<Heartbeat>(*writer_);
    control_ = std::make_unique<ControlServer>(*writer_);
    calibration_ = thesis_camera_ii();
    calibration_.harvester.tip = {0, 0, 150};
    calibration_.harvester.axis = {0, 0, -1};
    writer_->publish_calibration(calibration_text(calibration_).value());
    writer_->set_state(DaemonState::idle, "");
  }
  ~FakeDaemon() {
    control_.reset();
    heartbeat_.reset();
  }

  const std::string& segment() const { return segment_; }
  SegmentWriter& writer() { return *writer_; }
  const Calibration& calibration() const { return calibration_; }

  static Rigid<World, Object> world_from_object() {
    return {Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())),
            {120, -40, 30}};
  }

  /// 80 mm above the board, looking down.
  static Rigid<World, Endoscope> world_from_endoscope() {
    const Rigid<Object, Endoscope> above(
        Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX())), {0, 0, 80});
    return world_from_object() * above;
  }

  /// All three tools, now. The harvester's tip touches the board at (0, 0), its axis leans by `tilt_rad`.
  void publish_tools(double tilt_rad, ToolState object = ToolState::ok, ToolState harvester = ToolState::ok) {
    const Nanoseconds now = monotonic_now();
    publish(0, SensorRole::endoscope, ToolState::ok, renamed<World, Sensor>(world_from_endoscope()), now);
    publish(1, SensorRole::object, object, renamed<World, Sensor>(world_from_object()), now);
    const Eigen::Quaterniond upside_down(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
    const Eigen::Quaterniond lean(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY()));
    const Rigid<Object, Sensor> turned(lean * upside_down, {0, 0, 0});
    const Rigid<Object, Sensor> placed(turned.rotation(), -turned.rotate(calibration_.harvester.tip));
    publish(2, SensorRole::harvester, harvester, world_from_object_of(placed), now);
  }

  /// A line along x at y, points 0.1 mm apart.
  PublishOutcome publish_line(double y_mm, ToolState object = ToolState::ok) {
    std::vector<SurfacePoint> points;
    for (int i = -60; i <= 60; ++i) {
      const Eigen::Vector3d on_board(0.1 * i, y_mm, 0);
      points.push_back({(world_from_object() * on_board).cast<float>(), 200.0F, 0.05F});
    }
    ScanLineInfo info;
    info.time = monotonic_now();
    info.frame = ++frames_;
    info.endoscope = {world_from_endoscope(), ToolState::ok};
    info.object = {world_from_object(), object};
    info.quality.coverage = 0.8F;
    info.quality.mean_snr = 20;
    return writer_->publish_line(info, points);
  }
  void start_scan() {
    writer_->begin_scan(monotonic_now());
    writer_->set_scanning(true);
  }
  /// Lines 0.2 mm apart over a board of 12 x 12 mm.
  void publish_board() {
    for (int i = -30; i <= 30; ++i) publish_line(0.2 * i);
  }

  /// Carries out nothing, remembers everything.
  std::vector<CommandKind> poll_commands() {
    std::vector<CommandKind> kinds;
    control_->poll(monotonic_now(), [&](const ReceivedCommand& command) {
      kinds.push_back(command.kind);
      return CommandAnswer{AnswerKind::done, ""};
    });
    return kinds;
  }

 private:
  static Rigid<World, Sensor> world_from_object_of(const Rigid<Object, Sensor>& placed) {
    return world_from_object() * placed;
  }
  void publish(int station, SensorRole role, ToolState state, const Rigid<World, Sensor>& pose,
               Nanoseconds now) {
    SensorStatus status;
    status.role = role;
    status.state = state;
    status.time = now;
    status.reason = usable(state) ? "" : "the test says so";
    writer_->set_sensor_status(station, status);
    PoseSample sample;
    sample.time = now;
    sample.station = static_cast<std::uint8_t>(station);
    sample.state = state;
    sample.world_from_sensor = pose;
    writer_->publish_pose(sample);
  }

  std::string segment_;
  std::optional<SegmentWriter> writer_;
  std::unique_ptr<Heartbeat> heartbeat_;
  std::unique_ptr<ControlServer> control_;
  Calibration calibration_;
  std::uint64_t frames_ = 0;
};

}  // namespace linescope::testing
