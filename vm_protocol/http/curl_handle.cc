#include "vm_protocol/http/curl_handle.h"

#include <algorithm>
#include <stdexcept>

#include "vm_protocol/core/lower_case.h"

namespace vm {
namespace {

constexpr std::size_t kMaxHeaders = 100;

/// Names of this machine: they are reached directly, whatever proxy the environment names.
bool IsHere(const std::string& url) {
  for (const char* place : {"://127.", "://localhost", "://[::1]"}) {
    if (url.find(place) < 8) return true;
  }
  return false;
}

}  // namespace

void StartCurl() {
  static const CURLcode started = curl_global_init(CURL_GLOBAL_DEFAULT);
  static_cast<void>(started);
}

CurlHeaders SetUpRequest(CURL* handle, const HttpRequest& request, const std::string& ca_file) {
  if (handle == nullptr) throw std::runtime_error("libcurl gives no handle");
  curl_easy_setopt(handle, CURLOPT_URL, request.url.c_str());
  curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(handle, CURLOPT_TIMEOUT_MS, static_cast<long>(request.limit.count()));
  curl_easy_setopt(handle, CURLOPT_USERAGENT, "Galatea/" GALATEA_VERSION);
  curl_easy_setopt(handle, CURLOPT_TCP_NODELAY, 1L);
  if (!ca_file.empty()) curl_easy_setopt(handle, CURLOPT_CAINFO, ca_file.c_str());
  if (request.unpacked) curl_easy_setopt(handle, CURLOPT_ACCEPT_ENCODING, "");
  if (IsHere(request.url)) curl_easy_setopt(handle, CURLOPT_PROXY, "");
  CurlHeaders headers;
  for (const std::string& line : request.headers)
    headers.reset(curl_slist_append(headers.release(), line.c_str()));
  // Without this a body of more than 1 KiB waits for "100 Continue".
  headers.reset(curl_slist_append(headers.release(), "Expect:"));
  curl_easy_setopt(handle, CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(handle, CURLOPT_POSTFIELDSIZE_LARGE,
                   static_cast<curl_off_t>(request.body.size()));
  curl_easy_setopt(handle, CURLOPT_POSTFIELDS, request.body.c_str());
  return headers;
}

void AddHeaderLine(std::string_view line, HttpHead& head) {
  if (line.starts_with("HTTP/")) head.headers.clear();
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || head.headers.size() >= kMaxHeaders) return;
  std::string_view value = line.substr(colon + 1);
  value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
  value = value.substr(0, value.find_last_not_of(" \t\r\n") + 1);
  head.headers[LowerCase(line.substr(0, colon))] = value;
}

Error TooLongAnswer(const HttpRequest& request) {
  return {Errc::kTooLong,
          "the answer has more than " + std::to_string(request.max_bytes) + " bytes", 0};
}

Result<void> CurlOutcome(CURLcode code) {
  if (code == CURLE_OK) return {};
  return Fail(code == CURLE_OPERATION_TIMEDOUT ? Errc::kTimeout : Errc::kUnavailable,
              curl_easy_strerror(code));
}

}  // namespace vm
