#include <cmath>

#include "render/api/renderer.hpp"
#include "session/commands/commands.hpp"
#include "session/inspection/snapping.hpp"
#include "session/library/scene_description.hpp"
#include "session/nodes/node_state.hpp"

// What is at a point of the image.

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::ImagePoint;
using protocol::Inspection;
using protocol::PickResult;
using protocol::Result;
using protocol::SceneSnap;
using protocol::SnapResult;

namespace {

/// Name of the instance: of its nearest node with a name, else of its mesh.
std::string object_name(const scene::Scene& scene, const scene::Instance& instance) {
  std::optional<std::uint32_t> node = instance.node;
  for (; node; node = scene.nodes[*node].parent) {
    if (!scene.nodes[*node].name.empty()) return scene.nodes[*node].name;
  }
  return scene.meshes[instance.mesh].name;
}

PickResult describe(const render::SurfacePoint& surface, const scene::Scene& scene) {
  const scene::Instance& instance = scene.instances.at(surface.instance);
  const std::uint32_t material = scene.meshes[instance.mesh].material;
  return {.hit = true,
          .position = to_protocol(surface.position),
          .normal = to_protocol(surface.normal),
          .distance = surface.distance,
          .object = object_name(scene, instance),
          .material = describe_materials(scene).at(material).name,
          .node = nodes_of_instances(scene).at(surface.instance)};
}

template <class Request>
glm::vec2 at(const Request& request) {
  return {request.x, request.y};
}

Result<std::optional<render::SurfacePoint>> pick(const render::Renderer& renderer,
                                                 const RenderState& state, glm::vec2 point) {
  if (!state.scene) return protocol::error::not_ready("no scene is loaded");
  return renderer.pick(point);
}

Inspection inspect(const render::Renderer& renderer, const RenderState& state, glm::vec2 point) {
  const auto pixel = [](float fraction, std::uint32_t size) {
    return std::min(static_cast<std::uint32_t>(fraction * static_cast<float>(size)), size - 1);
  };
  Inspection inspection{.column = pixel(point.x, state.width),
                        .row = pixel(point.y, state.height),
                        .width = state.width,
                        .height = state.height,
                        .buffers = {}};
  for (const render::BufferValue& buffer : renderer.inspect(point)) {
    protocol::BufferValue value{.name = buffer.name, .value = {}, .unit = buffer.unit};
    for (const float channel : buffer.channels) {
      value.value.push_back(std::isfinite(channel) ? std::optional(channel) : std::nullopt);
    }
    inspection.buffers.push_back(std::move(value));
  }
  return inspection;
}

/// A probe waits in its session, which it must not keep.
using AskedSession = std::weak_ptr<Session>;

/// Adds a method that reads from the frame. `reads_buffers`: see Probe.
template <class Method, class Read>
void add_probe(protocol::Dispatcher& dispatcher, SessionHost& host, bool reads_buffers, Read read) {
  dispatcher.add<Method>(
      [&host, reads_buffers, read](const typename Method::Params& request,
                                   const protocol::CallContext& context,
                                   protocol::Completion<typename Method::Result> done) {
        const auto session = host.sessions().session_of(context);
        if (!session) return done(session.error());
        const Result<void> accepted = (*session)->captures().request_probe(
            {.reads_buffers = reads_buffers,
             .read = [read, request, done, asked = std::weak_ptr<Session>(*session)](
                         render::Renderer& renderer,
                         const RenderState& state) { done(read(renderer, state, request, asked)); },
             .fail = [done](const protocol::Error& error) { done(error); }});
        if (!accepted) done(accepted.error());
      });
}

}  // namespace

void add_probe_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_probe<methods::scene_pick>(
      dispatcher, host, false,
      [](const render::Renderer& renderer, const RenderState& state, const ImagePoint& request,
         const AskedSession&) -> Result<PickResult> {
        const auto surface = pick(renderer, state, at(request));
        if (!surface) return surface.error();
        if (!*surface) return PickResult();
        return describe(**surface, *state.scene);
      });
  add_probe<methods::scene_snap>(
      dispatcher, host, false,
      [](const render::Renderer& renderer, const RenderState& state, const SceneSnap& request,
         const AskedSession&) -> Result<SnapResult> {
        const auto surface = pick(renderer, state, at(request));
        if (!surface) return surface.error();
        if (!*surface) return SnapResult();
        return snap(state, **surface, request);
      });
  add_probe<methods::annotations_hidden>(
      dispatcher, host, false,
      [](const render::Renderer& renderer, const RenderState& state, const protocol::Empty&,
         const AskedSession& asked) -> Result<protocol::HiddenAnnotations> {
        const auto session = asked.lock();
        if (!session || !state.scene) return protocol::HiddenAnnotations();
        return hidden_annotations(renderer, FrameView(state), session->annotations().list());
      });
  add_probe<methods::frame_inspect>(
      dispatcher, host, true,
      [](const render::Renderer& renderer, const RenderState& state, const ImagePoint& request,
         const AskedSession&) -> Result<Inspection> {
        return inspect(renderer, state, at(request));
      });
}

}  // namespace heliograph::session
