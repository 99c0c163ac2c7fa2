#include "ssm/voice/markup_uri.h"

#include <cctype>

namespace ssm {
namespace {

/// The length of "scheme:" at the beginning; 0 if there is none.
std::size_t SchemeOf(std::string_view uri) {
  if (uri.empty() || std::isalpha(static_cast<unsigned char>(uri[0])) == 0) return 0;
  for (std::size_t at = 1; at < uri.size(); ++at) {
    if (uri[at] == ':') return at + 1;
    const bool inside = std::isalnum(static_cast<unsigned char>(uri[at])) != 0 ||
                        std::string_view("+-.").contains(uri[at]);
    if (!inside) return 0;
  }
  return 0;
}

/// The length of "scheme://host".
std::size_t OriginOf(std::string_view uri) {
  const std::size_t scheme = SchemeOf(uri);
  if (!uri.substr(scheme).starts_with("//")) return scheme;
  const std::size_t path = uri.find('/', scheme + 2);
  return path == uri.npos ? uri.size() : path;
}

}  // namespace

std::string ResolveUri(std::string_view base, std::string_view reference) {
  if (reference.empty()) return std::string(base);
  if (base.empty() || SchemeOf(reference) > 0) return std::string(reference);
  const std::size_t origin = OriginOf(base);
  std::string joined(base.substr(0, origin));
  if (reference.starts_with("//")) {
    joined.erase(SchemeOf(base));
  } else if (!reference.starts_with('/')) {
    const std::size_t slash = base.rfind('/');
    const bool has_folder = slash != base.npos && slash >= origin;
    if (has_folder) joined = base.substr(0, slash + 1);
    if (!has_folder && origin > 0) joined += '/';
  }
  return joined + std::string(reference);
}

std::string FilePathOf(std::string_view uri) {
  constexpr std::string_view kFile = "file:";
  if (!uri.starts_with(kFile)) return std::string(uri);
  uri.remove_prefix(kFile.size());
  if (uri.starts_with("//")) uri.remove_prefix(2);
  if (uri.starts_with("localhost/")) uri.remove_prefix(9);
  return std::string(uri);
}

}  // namespace ssm
