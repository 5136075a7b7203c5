#include "session/commands/commands.hpp"
#include "session/edits/texture_edits.hpp"

// Textures of materials, and the images that can take their place.

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Empty;
using protocol::UploadKind;

void add_texture_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::images_list>(
      dispatcher, host,
      [&host](Session&, const Empty&, const std::string&) -> protocol::Result<protocol::ImageList> {
        protocol::ImageList list;
        for (const CatalogueEntry& entry : list_images(host.images())) {
          list.images.push_back({.name = entry.name,
                                 .bytes = entry.bytes,
                                 .uploaded = host.was_uploaded(UploadKind::image, entry)});
        }
        return list;
      });
  add_command<methods::textures_list>(dispatcher, host,
                                      [](Session& session, const Empty&, const std::string&) {
                                        return session.scene().textures();
                                      });
  dispatcher.add<methods::textures_set>([&host](const protocol::TextureSet& request,
                                                const protocol::CallContext& context,
                                                protocol::Completion<protocol::TextureState> done) {
    const auto session = host.sessions().session_of(context);
    if (!session) return done(session.error());
    host.set_texture(*session, request, context.viewer, std::move(done));
  });
}

}  // namespace heliograph::session
