#include "task_manager/fetch/uri.h"

#include <cctype>
#include <filesystem>
#include <vector>

namespace vxml::fetch {
namespace {

bool IsSchemeChar(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
}

std::string RemoveDots(const std::string& path) {
  std::vector<std::string> kept;
  const bool absolute = path.starts_with("/");
  bool folder = false;
  for (std::size_t at = absolute ? 1 : 0; at <= path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    const std::string part = path.substr(at, end - at);
    const bool last = end == path.size();
    folder = last && (part.empty() || part == "." || part == "..");
    if (part == "..") {
      if (!kept.empty()) kept.pop_back();
    } else if (part != "." && !(last && part.empty())) {
      kept.push_back(part);
    }
    at = end + 1;
  }
  std::string result = absolute ? "/" : "";
  for (std::size_t i = 0; i < kept.size(); ++i) result += (i ? "/" : "") + kept[i];
  if (folder && !result.ends_with("/")) result += "/";
  return result;
}

}  // namespace

Uri ParseUri(std::string_view text) {
  Uri uri;
  if (const std::size_t hash = text.find('#'); hash != std::string_view::npos) {
    uri.has_fragment = true;
    uri.fragment = text.substr(hash + 1);
    text = text.substr(0, hash);
  }
  std::size_t scheme = 0;
  while (scheme < text.size() && IsSchemeChar(text[scheme])) ++scheme;
  if (scheme > 0 && scheme < text.size() && text[scheme] == ':' &&
      std::isalpha(static_cast<unsigned char>(text[0])) != 0) {
    for (const char c : text.substr(0, scheme)) {
      uri.scheme += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    text.remove_prefix(scheme + 1);
  }
  if (const std::size_t query = text.find('?'); query != std::string_view::npos) {
    uri.has_query = true;
    uri.query = text.substr(query + 1);
    text = text.substr(0, query);
  }
  if (text.starts_with("//")) {
    uri.has_authority = true;
    const std::size_t end = std::min(text.find('/', 2), text.size());
    uri.authority = text.substr(2, end - 2);
    text.remove_prefix(end);
  }
  uri.path = text;
  return uri;
}

std::string FormatUri(const Uri& uri) {
  std::string text;
  if (!uri.scheme.empty()) text += uri.scheme + ":";
  if (uri.has_authority) text += "//" + uri.authority;
  text += uri.path;
  if (uri.has_query) text += "?" + uri.query;
  if (uri.has_fragment) text += "#" + uri.fragment;
  return text;
}

std::string Resolve(const std::string& base, const std::string& reference) {
  if (base.empty()) return reference;
  Uri r = ParseUri(reference);
  if (!r.scheme.empty()) return reference;
  const Uri b = ParseUri(base);
  Uri t = r;
  t.scheme = b.scheme;
  if (!r.has_authority) {
    t.authority = b.authority;
    t.has_authority = b.has_authority;
    if (r.path.empty()) {
      t.path = b.path;
      if (!r.has_query) {
        t.has_query = b.has_query;
        t.query = b.query;
      }
    } else if (r.path.starts_with("/")) {
      t.path = RemoveDots(r.path);
    } else {
      const std::size_t slash = b.path.rfind('/');
      const std::string folder =
          slash == std::string::npos ? (b.has_authority ? "/" : "") : b.path.substr(0, slash + 1);
      t.path = RemoveDots(folder + r.path);
    }
  }
  return FormatUri(t);
}

std::string WithoutFragment(const std::string& uri) { return uri.substr(0, uri.find('#')); }
std::string Fragment(const std::string& uri) {
  const std::size_t hash = uri.find('#');
  return hash == std::string::npos ? "" : uri.substr(hash + 1);
}

std::string FromPath(const std::string& path_or_uri) {
  const Uri uri = ParseUri(path_or_uri);
  if (uri.scheme.size() > 1) return path_or_uri;
  std::string path = std::filesystem::absolute(path_or_uri).lexically_normal().string();
  std::string encoded;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte <= ' ' || byte >= 0x7F || c == '%' || c == '?' || c == '#') {
      encoded += PercentEncode(std::string_view(&c, 1));
    } else {
      encoded += c;
    }
  }
  return "file://" + encoded;
}

std::string PercentDecode(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto hex = [&](std::size_t at) {
      const char c = at < text.size() ? text[at] : '!';
      if (c >= '0' && c <= '9') return c - '0';
      if (c >= 'a' && c <= 'f') return c - 'a' + 10;
      if (c >= 'A' && c <= 'F') return c - 'A' + 10;
      return -1;
    };
    if (text[i] == '%' && hex(i + 1) >= 0 && hex(i + 2) >= 0) {
      decoded += static_cast<char>(hex(i + 1) * 16 + hex(i + 2));
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

std::string PercentEncode(std::string_view text) {
  static constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    if (plain) {
      encoded += c;
    } else {
      encoded += '%';
      encoded += kHex[byte / 16];
      encoded += kHex[byte % 16];
    }
  }
  return encoded;
}

}  // namespace vxml::fetch
