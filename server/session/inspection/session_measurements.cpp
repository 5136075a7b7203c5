#include "session/inspection/session_measurements.hpp"

#include "session/inspection/session_marks.hpp"

namespace heliograph::session {

using protocol::MeasurementList;
using protocol::Result;

namespace {

template <class Change>
Result<MeasurementList> change_measurements(SessionCore& core, const std::string& by,
                                            const Change& change) {
  return change_marks<protocol::notifications::measurements_changed>(core, &SessionCore::measured,
                                                                     by, change);
}

}  // namespace

MeasurementList SessionMeasurements::list() const {
  return list_marks(core_, &SessionCore::measured);
}

MeasurementList SessionMeasurements::list_in(const scene::Scene& scene,
                                             const scene::Pose& pose) const {
  return list_marks_in(core_, &SessionCore::measured, scene, pose);
}

Result<MeasurementList> SessionMeasurements::add(const protocol::MeasurementAdd& request,
                                                 const std::string& by) {
  return change_measurements(core_, by, [&](MeasurementSet& measured, const ScenePart& part) {
    return measured.add(part, *core_.scene, core_.nodes, request);
  });
}

Result<MeasurementList> SessionMeasurements::remove(const protocol::MeasurementId& request,
                                                    const std::string& by) {
  return change_measurements(core_, by, [&](MeasurementSet& measured, const ScenePart& part) {
    return measured.remove(part, request.id);
  });
}

Result<MeasurementList> SessionMeasurements::clear(const std::string& by) {
  return change_measurements(core_, by, [&](MeasurementSet& measured, const ScenePart& part) {
    measured.clear(part);
    return Result<void>();
  });
}

Result<MeasurementList> SessionMeasurements::set_unit(const protocol::MeasurementUnit& request,
                                                      const std::string& by) {
  return change_measurements(core_, by, [&](MeasurementSet& measured, const ScenePart&) {
    measured.set_unit(request.unit);
    return Result<void>();
  });
}

}  // namespace heliograph::session
