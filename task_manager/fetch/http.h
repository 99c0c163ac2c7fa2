#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "task_manager/fetch/fetcher.h"

namespace vxml::fetch {

/// One exchange over HTTP by libcurl.
struct HttpRequest {
  std::string uri;
  bool post = false;
  bool multipart = false;
  std::vector<Field> fields;
  std::vector<std::string> headers;
  std::chrono::milliseconds timeout{10'000};
  std::size_t max_bytes = 0;
  std::string user_agent;
};
struct HttpResponse {
  int status = 0;
  std::string body;
  std::map<std::string, std::string> headers;  ///< names in lower case
};
/// The cookies of one session (RFC 6265, libcurl's engine). In memory only; over kMaxCookies all
/// are forgotten. Thread: one.
class Cookies {
 public:
  static constexpr std::size_t kMaxCookies = 300;

  Cookies();
  ~Cookies();
  Cookies(const Cookies&) = delete;
  Cookies& operator=(const Cookies&) = delete;

 private:
  friend std::expected<HttpResponse, Failure> Exchange(const HttpRequest&, Cookies&);
  void* share_;  ///< libcurl's CURLSH
};

/// Does not follow redirections (the caller checks where they lead). Any status is a success here.
std::expected<HttpResponse, Failure> Exchange(const HttpRequest& request, Cookies& cookies);

}  // namespace vxml::fetch
