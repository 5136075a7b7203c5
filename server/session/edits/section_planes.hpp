#pragma once

#include <memory>
#include <string>

#include "protocol/messages/section_messages.hpp"
#include "protocol/result.hpp"
#include "render/api/section.hpp"

namespace heliograph::session {

/// The planes that cut one session's scene open. Not thread safe.
class SectionPlanes {
 public:
  /// In place of those before; normals become unit vectors. `path` names the section in errors.
  /// @return an error where a normal is zero; nothing changes then
  protocol::Result<void> set(protocol::Section section, const std::string& path = {});

  const protocol::Section& get() const { return section_; }
  /// The enabled planes; null: none is. A change makes a new section.
  const std::shared_ptr<const render::Section>& enabled() const { return enabled_; }

 private:
  protocol::Section section_;
  std::shared_ptr<const render::Section> enabled_;
};

}  // namespace heliograph::session
