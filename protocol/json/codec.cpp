#include "protocol/json/codec.hpp"

#include "protocol/json/codec_templates.hpp"

namespace heliograph::protocol {

#define MESSAGE(T)                                   \
  template Result<T> decode<T>(const RawJson& json); \
  template RawJson encode<T>(const T& message);      \
  template RawJson schema_of<T>();

MESSAGE(Empty)
MESSAGE(RawJson)
MESSAGE(Hello)
MESSAGE(HelloResult)
MESSAGE(SessionInfo)
MESSAGE(SessionCreate)
MESSAGE(SessionChoice)
MESSAGE(SessionJoined)
MESSAGE(SessionList)
MESSAGE(SessionControl)
MESSAGE(SessionClosed)
MESSAGE(DeviceChanged)
MESSAGE(SceneListResult)
MESSAGE(SceneLoad)
MESSAGE(SceneCancelled)
MESSAGE(SceneInfo)
MESSAGE(SceneProgress)
MESSAGE(SceneChanged)
MESSAGE(Camera)
MESSAGE(CameraSet)
MESSAGE(CameraChanged)
MESSAGE(AnimationState)
MESSAGE(AnimationChanged)
MESSAGE(AnimationPlay)
MESSAGE(AnimationSeek)
MESSAGE(AnimationRate)
MESSAGE(SettingsState)
MESSAGE(SettingsPatch)
MESSAGE(SettingsApplied)
MESSAGE(SettingsChanged)
MESSAGE(PresetList)
MESSAGE(PresetChoice)
MESSAGE(StreamConfigure)
MESSAGE(StreamState)
MESSAGE(StreamAck)
MESSAGE(StatsSubscription)
MESSAGE(StatsFrame)
MESSAGE(FrameBuffers)
MESSAGE(FrameCapture)
MESSAGE(CapturedFrame)
MESSAGE(SceneUnloaded)
MESSAGE(FrameStep)
MESSAGE(StepState)
MESSAGE(LockstepChanged)
MESSAGE(ReferenceStart)
MESSAGE(ReferenceState)
MESSAGE(CameraOrbit)
MESSAGE(LightList)
MESSAGE(LightsPatch)
MESSAGE(LightState)
MESSAGE(LightsChanged)
MESSAGE(MaterialList)
MESSAGE(MaterialsPatch)
MESSAGE(MaterialState)
MESSAGE(MaterialsChanged)
MESSAGE(EnvironmentState)
MESSAGE(EnvironmentSet)
MESSAGE(EnvironmentChanged)
MESSAGE(ImagePoint)
MESSAGE(PickResult)
MESSAGE(Inspection)

#undef MESSAGE

}  // namespace heliograph::protocol
