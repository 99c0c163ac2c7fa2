#pragma once

#include <chrono>
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
/// Does not follow redirections (the caller checks where they lead). Any status is a success here.
std::expected<HttpResponse, Failure> Exchange(const HttpRequest& request);

}  // namespace vxml::fetch
