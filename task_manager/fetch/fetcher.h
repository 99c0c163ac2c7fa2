#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "task_manager/fetch/uri.h"
#include "vm_protocol/core/result.h"

namespace vm {
class HttpCaller;
}

namespace vxml::fetch {

/// What the configuration allows and how much one fetch may cost.
struct Options {
  /// Places that may be fetched with all below them ("file:///srv/dialogs/",
  /// "http://127.0.0.1:8080/", Place::Holds). Empty: everything of file, http, https and data.
  std::vector<std::string> allowed_roots{};
  std::size_t max_bytes = std::size_t{16} << 20;
  std::chrono::milliseconds default_timeout{10'000};
  std::size_t cache_bytes = std::size_t{64} << 20;
  /// Seconds since the epoch, for the cache; the system's clock if empty.
  std::function<long long()> now{};
};

/// One part of a submit.
struct Field {
  std::string name;
  std::string value;
  std::string content_type;  ///< of multipart parts; empty = text
  std::string file_name;
};

struct Request {
  std::string uri;
  std::string from{};  ///< URI of the document or grammar that asks; "" = the user (MayRead)
  bool post = false;
  bool multipart = false;
  std::vector<Field> fields{};
  std::optional<std::chrono::milliseconds> timeout{};
  std::optional<long long> max_age{};    ///< seconds (VoiceXML maxage)
  std::optional<long long> max_stale{};  ///< seconds
};

struct Response {
  std::string body;
  std::string uri;           ///< after redirections, with the request's fragment removed
  std::string content_type;  ///< media type, lower case, without parameters
  std::string charset;
  bool from_cache = false;
};

/// HTTP status of a failed fetch where there is one. kAccess: not allowed. kTimeout. kTooLong.
/// kUnavailable: not found, refused, no such host. kBadValue: not a URI this fetcher knows.
struct Failure : vm::Error {
  int http_status = 0;
};

/// Gets resources by file, http, https and data URIs. http is cached by RFC 9111's rules as far
/// as a private cache of GET answers needs: max-age, Expires, no-store, no-cache, must-revalidate,
/// ETag, Last-Modified, Age. Cookies are kept as long as the fetcher lives.
/// Thread: one instance, one thread. Blocks up to the timeout.
class Fetcher {
 public:
  /// Throws std::runtime_error if an allowed root is no file, http or https URI.
  explicit Fetcher(Options options);
  ~Fetcher();
  Fetcher(const Fetcher&) = delete;
  Fetcher& operator=(const Fetcher&) = delete;

  vm::Result<Response> Get(const std::string& uri);
  std::expected<Response, Failure> Fetch(const Request& request);

 private:
  std::expected<Response, Failure> FetchFile(const Request& request);
  std::expected<Response, Failure> FetchData(const Request& request);
  std::expected<Response, Failure> FetchHttp(const Request& request);
  bool Allowed(const std::string& uri) const;

  struct Cache;
  Options options_;
  std::vector<Place> roots_;
  std::unique_ptr<Cache> cache_;
  std::unique_ptr<vm::HttpCaller> http_;
};

/// name=value&... in UTF-8 (application/x-www-form-urlencoded).
std::string FormEncode(const std::vector<Field>& fields);

}  // namespace vxml::fetch
