#include "task_manager/fetch/uri.h"

#include <curl/curl.h>

#include <algorithm>
#include <memory>

#include "vm_protocol/core/lower_case.h"

namespace vxml::fetch {
namespace {

struct CurlFree {
  void operator()(CURLU* handle) const { curl_url_cleanup(handle); }
  void operator()(char* text) const { curl_free(text); }
};
using CurlText = std::unique_ptr<char, CurlFree>;

class Url {
 public:
  Url() : handle_(curl_url()) {}
  explicit Url(const std::string& text) : Url() { ok_ = Set(CURLUPART_URL, text); }

  /// Setting CURLUPART_URL a second time resolves a reference.
  bool Set(CURLUPart part, const std::string& text, unsigned flags = 0) {
    constexpr unsigned kAlways = CURLU_NON_SUPPORT_SCHEME | CURLU_URLENCODE;
    if (text.find('\0') != std::string::npos) return false;
    if (part == CURLUPART_URL) flags |= kAlways;
    return curl_url_set(handle_.get(), part, text.c_str(), flags) == CURLUE_OK;
  }
  std::optional<std::string> Get(CURLUPart part, unsigned flags = 0) const {
    char* text = nullptr;
    if (curl_url_get(handle_.get(), part, &text, flags) != CURLUE_OK) return {};
    return CurlText(text).get();
  }
  bool ok() const { return ok_; }

 private:
  std::unique_ptr<CURLU, CurlFree> handle_;
  bool ok_ = false;
};

bool IsData(const std::string& uri) { return vm::LowerCase(uri.substr(0, 5)) == "data:"; }

}  // namespace

std::string Resolve(const std::string& base, const std::string& reference) {
  if (base.empty() || IsData(reference)) return reference;
  // libcurl before 8 loses the last part of the path where a reference has none.
  const std::string fragment = reference.substr(std::min(reference.find('#'), reference.size()));
  if (fragment.size() == reference.size()) return WithoutFragment(base) + fragment;
  Url url(WithoutFragment(base));
  if (!url.ok() || !url.Set(CURLUPART_URL, WithoutFragment(reference))) return reference;
  return url.Get(CURLUPART_URL).value_or(reference) + fragment;
}

std::string WithoutFragment(const std::string& uri) { return uri.substr(0, uri.find('#')); }
std::string Fragment(const std::string& uri) {
  const std::size_t hash = uri.find('#');
  return hash == std::string::npos ? "" : uri.substr(hash + 1);
}

std::string Scheme(const std::string& uri) {
  return IsData(uri) ? "data" : vm::LowerCase(Url(uri).Get(CURLUPART_SCHEME).value_or(""));
}
std::string Host(const std::string& uri) {
  return IsData(uri) ? "" : vm::LowerCase(Url(uri).Get(CURLUPART_HOST).value_or(""));
}
bool HasQuery(const std::string& uri) {
  return !IsData(uri) && Url(uri).Get(CURLUPART_QUERY).has_value();
}

std::string FromPath(const std::string& path_or_uri) {
  if (!Scheme(path_or_uri).empty()) return path_or_uri;
  Url url;
  const std::string path = std::filesystem::absolute(path_or_uri).lexically_normal().string();
  url.Set(CURLUPART_SCHEME, "file");
  url.Set(CURLUPART_PATH, path, CURLU_URLENCODE);
  return url.Get(CURLUPART_URL).value_or("");
}

std::optional<std::string> PathOf(const std::string& uri) {
  if (IsData(uri)) return {};
  const Url url(uri);
  if (url.Get(CURLUPART_SCHEME) != "file") return {};
  return url.Get(CURLUPART_PATH, CURLU_URLDECODE);
}

std::string PercentDecode(std::string_view text) {
  if (text.empty()) return "";  // to libcurl a length of 0 means up to the NUL
  int size = 0;
  const CurlText plain(
      curl_easy_unescape(nullptr, text.data(), static_cast<int>(text.size()), &size));
  return plain ? std::string(plain.get(), static_cast<std::size_t>(size)) : "";
}

std::string PercentEncode(std::string_view text) {
  if (text.empty()) return "";
  const CurlText escaped(curl_easy_escape(nullptr, text.data(), static_cast<int>(text.size())));
  return escaped ? escaped.get() : "";
}

bool Place::Holds(const Place& other) const {
  return origin == other.origin &&
         std::mismatch(path.begin(), path.end(), other.path.begin(), other.path.end()).first ==
             path.end();
}

std::optional<Place> PlaceOf(const std::string& uri) {
  if (IsData(uri)) return {};
  const Url url(uri);
  const auto scheme = url.Get(CURLUPART_SCHEME);
  const auto path = url.Get(CURLUPART_PATH, CURLU_URLDECODE);
  if (!scheme || !path) return {};
  Place place;
  place.origin = vm::LowerCase(*scheme) + ":";
  std::error_code failed;
  if (place.origin == "file:") {
    place.path = std::filesystem::weakly_canonical(*path, failed);
  } else {
    std::string host = vm::LowerCase(url.Get(CURLUPART_HOST).value_or(""));
    if (host.ends_with('.')) host.pop_back();
    place.origin += "//" + host + ":" + url.Get(CURLUPART_PORT, CURLU_DEFAULT_PORT).value_or("");
    place.path = std::filesystem::path(*path).lexically_normal();
  }
  if (failed) return {};
  if (!place.path.has_filename()) place.path = place.path.parent_path();
  return place;
}

bool IsLocal(const std::string& uri) { return uri.empty() || Scheme(uri) == "file"; }
bool MayRead(const std::string& from, const std::string& uri) {
  return Scheme(uri) != "file" || IsLocal(from);
}

}  // namespace vxml::fetch
