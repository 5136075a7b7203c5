#include "session/inspection/session_measurements.hpp"

#include "session/inspection/anchors.hpp"

namespace heliograph::session {

using protocol::MeasurementList;
using protocol::Result;

MeasurementList SessionMeasurements::list() const {
  std::unique_lock lock(core_.mutex);
  if (!core_.scene) return {};
  const MeasurementSet measured = core_.measured;  // shares its entries
  const std::shared_ptr<const scene::Scene> scene = core_.scene;
  const ScenePart part = core_.part();
  const std::string clip = core_.timeline.clock().clip;
  const double seconds = core_.clip_seconds();
  lock.unlock();  // a pose of many nodes takes milliseconds
  return measured.list(part, *scene, pose_at(*scene, clip, seconds));
}

template <class Change>
Result<MeasurementList> SessionMeasurements::change(const std::string& by, const Change& change) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  const ScenePart part = core_.part();
  if (const Result<void> done = change(part); !done) return done.error();
  core_.lead();
  const scene::Pose pose = pose_at(*core_.scene, core_.timeline.clock().clip, core_.clip_seconds());
  const protocol::MeasurementsChanged message{.list = core_.measured.list(part, *core_.scene, pose),
                                              .by = by};
  core_.notify_others_latest<protocol::notifications::measurements_changed>(by, message);
  return message.list;
}

Result<MeasurementList> SessionMeasurements::add(const protocol::MeasurementAdd& request,
                                                 const std::string& by) {
  return change(by, [&](const ScenePart& part) {
    return core_.measured.add(part, *core_.scene, core_.nodes, request);
  });
}

Result<MeasurementList> SessionMeasurements::remove(const protocol::MeasurementId& request,
                                                    const std::string& by) {
  return change(by, [&](const ScenePart& part) { return core_.measured.remove(part, request.id); });
}

Result<MeasurementList> SessionMeasurements::clear(const std::string& by) {
  return change(by, [&](const ScenePart& part) {
    core_.measured.clear(part);
    return Result<void>();
  });
}

Result<MeasurementList> SessionMeasurements::set_unit(const protocol::MeasurementUnit& request,
                                                      const std::string& by) {
  return change(by, [&](const ScenePart&) {
    core_.measured.set_unit(request.unit);
    return Result<void>();
  });
}

}  // namespace heliograph::session
