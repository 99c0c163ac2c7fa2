#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace vxml::fetch {

// URIs are read, joined and escaped by libcurl, so that what is judged here is what is fetched.
// data: and other URIs without a hierarchy (builtin:, recording:) stand as they are.

/// `reference` against `base` (RFC 3986 section 5.2). What cannot be joined comes back as it is.
std::string Resolve(const std::string& base, const std::string& reference);
std::string WithoutFragment(const std::string& uri);
std::string Fragment(const std::string& uri);
/// "file", "http", "data", ... in lower case; "" if this is no absolute URI.
std::string Scheme(const std::string& uri);
/// In lower case, "" if there is none.
std::string Host(const std::string& uri);
bool HasQuery(const std::string& uri);
/// A path of the file system, or a URI as it stands, as an absolute URI (file:///...).
std::string FromPath(const std::string& path_or_uri);
/// The path a file URI names; none for all others, and where it holds control characters.
std::optional<std::string> PathOf(const std::string& uri);
std::string PercentDecode(std::string_view text);
/// Everything but letters, digits, '-' '.' '_' '~' as %XX.
std::string PercentEncode(std::string_view text);

/// Where a URI leads, in the one form all its spellings share: of files the path with symbolic
/// links followed, of others scheme, host in lower case, port, and the path without escapes.
struct Place {
  std::string origin;
  std::filesystem::path path;  ///< absolute, without "..", "." and the last '/'

  /// Whether `other` is this place or lies below it, by whole components of the path.
  bool Holds(const Place& other) const;
};
/// None if `uri` is none with a hierarchy, or its links lead in circles.
std::optional<Place> PlaceOf(const std::string& uri);

/// Whether what came from `uri` acts for the user of this machine: it is a file of it, or "" (the
/// user). Everything else came over a network or out of the hands of something that did.
bool IsLocal(const std::string& uri);
/// Whether a document or grammar that came from `from` may read `uri`: files are read only by what
/// IsLocal.
bool MayRead(const std::string& from, const std::string& uri);

}  // namespace vxml::fetch
