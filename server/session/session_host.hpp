#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "protocol/json/jsonrpc.hpp"
#include "render/api/renderer.hpp"
#include "session/devices/render_devices.hpp"
#include "session/edits/scene_exporter.hpp"
#include "session/library/environment_library.hpp"
#include "session/library/scene_catalogue.hpp"
#include "session/library/scene_loader.hpp"
#include "session/library/scene_thumbnails.hpp"
#include "session/session_registry.hpp"

namespace heliograph::jobs {
class JobQueue;
}

namespace heliograph::session {

class UploadStore;

/// Where uploads are, each kind in a root of its own; empty: they are not allowed.
struct UploadRoots {
  std::filesystem::path scenes;
  std::filesystem::path environments;
  std::filesystem::path images;
};

struct HostOptions {
  SessionOptions session;  // the main one, and what others start with
  RegistryLimits limits;
  std::vector<std::filesystem::path> scene_roots;
  std::vector<std::filesystem::path> environment_roots;  // beside them
  std::vector<std::filesystem::path> image_roots;        // of textures
  UploadRoots upload_roots;                              // those of all these that hold uploads
  std::optional<std::filesystem::path> environment;      // for every scene, instead of its own
  scene::ImportLimits import_limits;
  std::uint64_t scene_cache_bytes = 1ull << 30;
  std::filesystem::path thumbnail_folder;  // of scenes; empty: in memory
  protocol::DispatchLimits dispatch;
  protocol::Annotators annotators = protocol::Annotators::control;
  /// Largest scene that clients may send; 0: none.
  std::uint64_t max_upload_bytes = 0;
  /// A session without viewers releases its renderer after so long.
  std::chrono::seconds release_after{120};
  /// Jobs beside the sessions; null: none. Must outlive the host's use, up to stop().
  jobs::JobQueue* jobs = nullptr;

  /// Where environments are looked for, in this order.
  std::vector<std::filesystem::path> all_environment_roots() const;
};

/// Everything of the server but its sockets: the sessions, what renders them and loads their
/// scenes, and the dispatcher of the clients' commands.
class SessionHost {
 public:
  /// Sessions on the devices of the engines, at least one, which must outlive it.
  /// @throws std::runtime_error, scene::ImportError
  SessionHost(const render::Engines& engines, HostOptions options);
  ~SessionHost();

  const protocol::Dispatcher& dispatcher() const { return dispatcher_; }
  const protocol::DispatchLimits& dispatch_limits() const { return options_.dispatch; }
  std::uint64_t max_upload_bytes() const { return options_.max_upload_bytes; }
  protocol::Annotators annotators() const { return options_.annotators; }
  const SceneCatalogue& catalogue() const { return catalogue_; }
  const RenderDevices& devices() const { return devices_; }

  SessionRegistry& sessions() { return sessions_; }
  const SessionRegistry& sessions() const { return sessions_; }
  EnvironmentLibrary& environments() { return environments_; }
  /// The images that may take the place of textures; see list_images.
  const SceneCatalogue& images() const { return images_; }
  SceneExporter& exporter() { return exporter_; }
  /// Whether a file of this kind's catalogue was uploaded, and not put there by others.
  bool was_uploaded(protocol::UploadKind kind, const CatalogueEntry& entry) const;
  /// Deletes an upload with its small image, and tells all viewers; see UploadStore::remove.
  protocol::Result<void> delete_upload(UploadStore& uploads, protocol::UploadKind kind,
                                       const std::string& name);
  /// To be called after an upload or its deletion: memory is freed, and all viewers are told.
  void uploads_changed(const protocol::UploadsChanged& change);
  /// The small image of a scene; see SceneThumbnails::get.
  protocol::Result<SceneThumbnails::File> scene_thumbnail(const std::string& scene);
  /// Null: there are none.
  jobs::JobQueue* jobs() const { return options_.jobs; }

  /// Creates a session. `done` is called once, here or when its scene is loaded; if that fails the
  /// session is closed. `device`: the index of that which renders it; empty: where there is room.
  using Created = std::function<void(protocol::Result<std::shared_ptr<Session>>)>;
  void create_session(const protocol::SessionCreate& request, const std::string& by, Created done,
                      std::optional<std::size_t> device = {});
  /// Gives a viewer a camera of its own; see SessionRegistry::detach.
  protocol::Result<std::shared_ptr<Session>> detach(const std::string& viewer);
  /// Finds a session for a viewer of an earlier server run; see SessionRegistry::resume.
  protocol::Result<Resumed> resume(const std::string& viewer, const Origin& from, bool read_only);
  void load_scene(std::shared_ptr<Session> session, const protocol::SceneLoad& request,
                  const std::string& by, SceneLoader::Completion done);
  /// Changes a texture of the session's scene; `done` is called once, when it is shown.
  void set_texture(const std::shared_ptr<Session>& session, const protocol::TextureSet& request,
                   const std::string& by, protocol::Completion<protocol::TextureState> done);
  /// Puts the document in the place of what was edited, but for its environment, and loads the
  /// scene again where its textures are others.
  void apply_edits(const std::shared_ptr<Session>& session, const protocol::EditDocument& document,
                   const std::string& by, std::function<void(protocol::Result<void>)> done);
  protocol::SceneCancelled cancel_load(const Session& session) { return loader_.cancel(session); }
  CacheTotals scene_cache_totals() const { return loader_.cache_totals(); }
  void on_first_frame(std::function<void()> callback);
  /// Whether a frame has been rendered and a device works.
  bool ready() const { return devices_.has_rendered() && devices_.ready(); }
  /// Readable text, while it is not.
  std::string not_ready_reason() const {
    return devices_.ready() ? "no frame has been rendered yet"
                            : "the device was lost and is being recovered";
  }
  /// Ends all threads. Pending requests fail before this returns, so their callers must outlive it.
  void stop();
  RenderTotals render_totals() const { return devices_.totals(); }

 private:
  void work_when_idle();
  Clock::duration do_idle_work();
  bool is_idle();
  void render_thumbnail(const std::string& scene, SceneThumbnails::Rendered done);
  void follow_jobs();
  void fail_creation(const std::shared_ptr<Session>& session, const protocol::Error& why,
                     const Created& done);

  const HostOptions options_;
  SceneCatalogue catalogue_;
  SceneCatalogue images_;
  RenderDevices devices_;
  SessionRegistry sessions_;
  protocol::Dispatcher dispatcher_;
  SceneLoader loader_;
  EnvironmentLibrary environments_;
  SceneThumbnails thumbnails_;
  SceneExporter exporter_;
  std::uint64_t frames_before_ = 0;  // of all sessions, when is_idle() was asked last
  WakeEvent idle_check_;
  std::atomic<bool> stopping_ = false;
  std::thread idle_thread_;
};

}  // namespace heliograph::session
