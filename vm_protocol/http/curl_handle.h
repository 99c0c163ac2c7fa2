#pragma once

#include <curl/curl.h>

#include <memory>
#include <string>
#include <string_view>

#include "vm_protocol/http/http.h"

/// What the two ways to carry a request by libcurl share; not for other folders.
namespace vm {

struct CurlFree {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
struct CurlShareFree {
  void operator()(CURLSH* share) const { curl_share_cleanup(share); }
};
struct CurlMultiFree {
  void operator()(CURLM* handle) const { curl_multi_cleanup(handle); }
};
using CurlHandle = std::unique_ptr<CURL, CurlFree>;
using CurlHeaders = std::unique_ptr<curl_slist, CurlFree>;
using CurlShare = std::unique_ptr<CURLSH, CurlShareFree>;
using CurlMulti = std::unique_ptr<CURLM, CurlMultiFree>;

/// Initialises libcurl, once in the life of the process.
void StartCurl();
/// Everything of a POST but what is done with the answer. The headers, and the request itself, must
/// live as long as the exchange. Throws std::runtime_error where `handle` is null.
CurlHeaders SetUpRequest(CURL* handle, const HttpRequest& request, const std::string& ca_file);
/// Takes one line of a head in; a status line begins a new head.
void AddHeaderLine(std::string_view line, HttpHead& head);
Error TooLongAnswer(const HttpRequest& request);
/// kTimeout or kUnavailable, in libcurl's words.
Result<void> CurlOutcome(CURLcode code);

}  // namespace vm
