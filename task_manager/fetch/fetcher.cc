#include "task_manager/fetch/fetcher.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "task_manager/fetch/cache.h"
#include "task_manager/fetch/uri.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/http/http_caller.h"
#include "vm_protocol/http/multipart.h"
#include "vm_protocol/runtime/base64.h"

namespace vxml::fetch {
namespace {

constexpr int kMaxRedirections = 10;
constexpr std::size_t kShownOrigin = 200;  // a data URI may be long

std::unexpected<Failure> Refuse(vm::Errc code, std::string text, int status = 0) {
  Failure failure;
  failure.code = code;
  failure.text = std::move(text);
  failure.http_status = status;
  return std::unexpected(std::move(failure));
}

/// "text/xml; charset=UTF-8" -> type and charset.
void SplitType(const std::string& header, Response& response) {
  const std::size_t semicolon = header.find(';');
  std::string type = vm::LowerCase(header.substr(0, semicolon));
  type.erase(type.find_last_not_of(" \t") + 1);
  response.content_type = type;
  const std::string lower = vm::LowerCase(header);
  const std::size_t at = lower.find("charset=");
  if (at == std::string::npos) return;
  std::string charset = lower.substr(at + 8);
  charset = charset.substr(0, charset.find(';'));
  std::erase(charset, '"');
  charset.erase(charset.find_last_not_of(" \t") + 1);
  response.charset = charset;
}

std::string TypeOfName(const std::string& path) {
  static const std::map<std::string, std::string> kTypes = {{".vxml", "application/voicexml+xml"},
                                                            {".grxml", "application/srgs+xml"},
                                                            {".gram", "application/srgs"},
                                                            {".abnf", "application/srgs"},
                                                            {".xml", "application/xml"},
                                                            {".js", "text/javascript"},
                                                            {".es", "text/javascript"},
                                                            {".wav", "audio/x-wav"},
                                                            {".au", "audio/basic"},
                                                            {".ulaw", "audio/basic"}};
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) return "";
  const auto found = kTypes.find(vm::LowerCase(path.substr(dot)));
  return found == kTypes.end() ? "" : found->second;
}

void SetBody(const Request& request, vm::HttpRequest& http) {
  if (!request.multipart) {
    http.body = FormEncode(request.fields);
    http.headers.push_back("Content-Type: application/x-www-form-urlencoded");
    return;
  }
  std::vector<vm::FormPart> parts;
  for (const Field& field : request.fields)
    parts.push_back({field.name, field.value, field.file_name, field.content_type});
  vm::SetForm(parts, http);
}

}  // namespace

struct Fetcher::Cache : HttpCache {
  using HttpCache::HttpCache;
};

std::string FormEncode(const std::vector<Field>& fields) {
  std::string text;
  for (const Field& field : fields) {
    if (!text.empty()) text += '&';
    text += PercentEncode(field.name) + "=" + PercentEncode(field.value);
  }
  return text;
}

Fetcher::Fetcher(Options options)
    : options_(std::move(options)),
      cache_(std::make_unique<Cache>(options_.cache_bytes)),
      http_(std::make_unique<vm::HttpCaller>("", true)) {
  if (!options_.now) {
    options_.now = [] {
      return std::chrono::duration_cast<std::chrono::seconds>(
                 std::chrono::system_clock::now().time_since_epoch())
          .count();
    };
  }
  for (const std::string& root : options_.allowed_roots) {
    const auto place = PlaceOf(root);
    if (!place) throw std::runtime_error("'" + root + "': no place to fetch from");
    roots_.push_back(*place);
  }
}
Fetcher::~Fetcher() = default;

vm::Result<Response> Fetcher::Get(const std::string& uri) {
  Request request;
  request.uri = uri;
  auto got = Fetch(request);
  if (!got) return std::unexpected(static_cast<vm::Error>(got.error()));
  return std::move(*got);
}

bool Fetcher::Allowed(const std::string& uri) const {
  if (roots_.empty() || Scheme(uri) == "data") return true;
  const auto place = PlaceOf(uri);
  return place && std::any_of(roots_.begin(), roots_.end(),
                              [&](const Place& root) { return root.Holds(*place); });
}

std::expected<Response, Failure> Fetcher::Fetch(const Request& original) {
  Request request = original;
  request.uri = WithoutFragment(request.uri);
  if (!request.post && !request.fields.empty()) {
    request.uri += (request.uri.find('?') == std::string::npos ? "?" : "&");
    request.uri += FormEncode(request.fields);
    request.fields.clear();
  }
  const std::string scheme = Scheme(request.uri);
  if (!Allowed(request.uri)) {
    return Refuse(vm::Errc::kAccess,
                  request.uri + ": outside of the places fetching is allowed from");
  }
  if (!MayRead(request.from, request.uri)) {
    return Refuse(vm::Errc::kAccess, request.uri + ": " + request.from.substr(0, kShownOrigin) +
                                         " is no file and may not read files");
  }
  if (scheme == "file") return FetchFile(request);
  if (scheme == "data") return FetchData(request);
  if (scheme == "http" || scheme == "https") return FetchHttp(request);
  return Refuse(vm::Errc::kBadValue, request.uri + ": expected a file, http, https or data URI");
}

std::expected<Response, Failure> Fetcher::FetchFile(const Request& request) {
  const auto place = PlaceOf(request.uri);  // opened where it was judged, its links followed
  std::error_code error;
  const auto size = place ? std::filesystem::file_size(place->path, error) : 0;
  if (!place || error || !std::filesystem::is_regular_file(place->path, error)) {
    return Refuse(vm::Errc::kUnavailable, request.uri + ": no such file");
  }
  if (size > options_.max_bytes) {
    return Refuse(vm::Errc::kTooLong,
                  request.uri + ": over " + std::to_string(options_.max_bytes) + " bytes");
  }
  std::ifstream file(place->path, std::ios::binary);
  if (!file) return Refuse(vm::Errc::kUnavailable, request.uri + ": cannot be read");
  Response response;
  response.body.resize(size);
  file.read(response.body.data(), static_cast<std::streamsize>(size));
  response.body.resize(static_cast<std::size_t>(file.gcount()));
  response.uri = request.uri;
  response.content_type = TypeOfName(request.uri);
  return response;
}

std::expected<Response, Failure> Fetcher::FetchData(const Request& request) {
  const std::size_t comma = request.uri.find(',');
  if (comma == std::string::npos) {
    return Refuse(vm::Errc::kBadValue, "data URI without ','");
  }
  Response response;
  std::string header = request.uri.substr(5, comma - 5);
  const bool base64 = header.ends_with(";base64");
  if (base64) header.erase(header.size() - 7);
  SplitType(header, response);
  const std::string body = PercentDecode(std::string_view(request.uri).substr(comma + 1));
  auto bytes = base64 ? vm::DecodeBase64(body) : body;
  if (!bytes) return Refuse(vm::Errc::kBadValue, "data URI that is not base64");
  response.body = std::move(*bytes);
  response.uri = request.uri;
  return response;
}

std::expected<Response, Failure> Fetcher::FetchHttp(const Request& request) {
  const auto deadline =
      std::chrono::steady_clock::now() + request.timeout.value_or(options_.default_timeout);
  std::string uri = request.uri;
  bool post = request.post;
  for (int turn = 0; turn <= kMaxRedirections; ++turn) {
    if (!Allowed(uri)) {
      return Refuse(vm::Errc::kAccess, uri + ": outside of the places fetching is allowed from");
    }
    vm::HttpRequest http{.url = uri, .max_bytes = options_.max_bytes, .unpacked = true};
    if (post) SetBody(request, http);
    http.limit = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (http.limit.count() <= 0) return Refuse(vm::Errc::kTimeout, uri + ": timed out");
    const CacheEntry* stored = post ? nullptr : cache_->Find(uri);
    const auto answer = [&](const vm::HttpAnswer& from, bool cached) {
      Response response;
      response.body = from.body;
      response.uri = uri;
      response.from_cache = cached;
      const auto type = from.head.headers.find("content-type");
      if (type != from.head.headers.end()) SplitType(type->second, response);
      return response;
    };
    if (stored && Usable(*stored, options_.now(), request.max_age, request.max_stale)) {
      return answer(stored->response, true);
    }
    if (stored) {
      const auto& headers = stored->response.head.headers;
      if (const auto tag = headers.find("etag"); tag != headers.end()) {
        http.headers.push_back("If-None-Match: " + tag->second);
      }
      if (const auto date = headers.find("last-modified"); date != headers.end()) {
        http.headers.push_back("If-Modified-Since: " + date->second);
      }
    }
    static const std::atomic<bool> kNeverCancelled = false;
    auto got = post ? http_->Post(http, http.limit, kNeverCancelled)
                    : http_->Get(http, http.limit, kNeverCancelled);
    if (!got) return Refuse(got.error().code, uri + ": " + got.error().text);
    const int status = got->head.status;
    if (status == 304 && stored) {
      return answer(cache_->Refresh(uri, *got, options_.now())->response, true);
    }
    const auto location = got->head.headers.find("location");
    if (status >= 300 && status < 400 && location != got->head.headers.end()) {
      uri = WithoutFragment(Resolve(uri, location->second));
      const std::string scheme = Scheme(uri);
      if (scheme != "http" && scheme != "https") {
        return Refuse(vm::Errc::kAccess, uri + ": a redirection out of http");
      }
      if (status != 307 && status != 308) post = false;
      continue;
    }
    if (status < 200 || status >= 300) {
      return Refuse(vm::Errc::kUnavailable, uri + ": HTTP status " + std::to_string(status),
                    status);
    }
    if (!post) cache_->Store(uri, *got, options_.now());
    return answer(*got, false);
  }
  return Refuse(vm::Errc::kUnavailable, request.uri + ": too many redirections");
}

}  // namespace vxml::fetch
