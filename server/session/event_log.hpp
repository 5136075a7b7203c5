#pragma once

#include <string_view>

namespace heliograph::session {

/// What a log entry is about, as far as it is known. Client addresses and names never hold
/// secrets; tokens and whole request lines do and have no place in the log.
struct LogSubject {
  std::string_view session;
  std::string_view viewer;
  std::string_view client;  // address
};

/// Between an entry's text and its members "name=value": no text that is logged holds it, see
/// `log_info`.
inline constexpr char log_separator = '\x1f';

/// Control characters in `text`, which could pretend to be other entries, are replaced.
void log_info(const LogSubject& subject, std::string_view text);
void log_warning(const LogSubject& subject, std::string_view text);
void log_error(const LogSubject& subject, std::string_view text);

}  // namespace heliograph::session
