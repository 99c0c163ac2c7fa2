#pragma once

#include <string>
#include <string_view>

namespace vxml::fetch {

/// The parts of a URI reference (RFC 3986).
struct Uri {
  std::string scheme;  ///< lower case, without ':'
  bool has_authority = false;
  std::string authority;
  std::string path;
  bool has_query = false;
  std::string query;
  bool has_fragment = false;
  std::string fragment;
};

Uri ParseUri(std::string_view text);
std::string FormatUri(const Uri& uri);
/// `reference` against `base` (RFC 3986 section 5.2); an empty base leaves it as it is.
std::string Resolve(const std::string& base, const std::string& reference);
std::string WithoutFragment(const std::string& uri);
std::string Fragment(const std::string& uri);
/// A path of the file system, or a URI as it stands, as an absolute URI (file:///...).
std::string FromPath(const std::string& path_or_uri);
std::string PercentDecode(std::string_view text);
/// Everything but letters, digits, '-' '.' '_' '~' as %XX.
std::string PercentEncode(std::string_view text);

}  // namespace vxml::fetch
