#include "task_manager/fetch/http.h"

#include <curl/curl.h>

#include <memory>

namespace vxml::fetch {
namespace {

struct Transfer {
  HttpResponse response;
  std::size_t max_bytes = 0;
  bool too_long = false;
};

std::size_t OnBody(char* data, std::size_t size, std::size_t count, void* self) {
  auto& transfer = *static_cast<Transfer*>(self);
  if (transfer.response.body.size() + size * count > transfer.max_bytes) {
    transfer.too_long = true;
    return 0;
  }
  transfer.response.body.append(data, size * count);
  return size * count;
}

std::size_t OnHeader(char* data, std::size_t size, std::size_t count, void* self) {
  auto& headers = static_cast<Transfer*>(self)->response.headers;
  std::string line(data, size * count);
  if (line.starts_with("HTTP/")) headers.clear();
  const std::size_t colon = line.find(':');
  if (colon != std::string::npos && headers.size() < 200) {
    std::string name = line.substr(0, colon);
    for (char& c : name) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    std::string value = line.substr(colon + 1);
    value.erase(0, value.find_first_not_of(" \t"));
    value.erase(value.find_last_not_of(" \t\r\n") + 1);
    headers[name] = value;
  }
  return size * count;
}

void StartOnce() {
  static const CURLcode started = curl_global_init(CURL_GLOBAL_DEFAULT);
  static_cast<void>(started);
}

struct CurlFree {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
  void operator()(curl_mime* mime) const { curl_mime_free(mime); }
};

void ForgetTooMany(CURL* handle) {
  curl_slist* known = nullptr;
  curl_easy_getinfo(handle, CURLINFO_COOKIELIST, &known);
  const std::unique_ptr<curl_slist, CurlFree> owner(known);
  std::size_t count = 0;
  for (const curl_slist* at = known; at; at = at->next) ++count;
  if (count > Cookies::kMaxCookies) curl_easy_setopt(handle, CURLOPT_COOKIELIST, "ALL");
}

}  // namespace

Cookies::Cookies() {
  StartOnce();
  share_ = curl_share_init();
  curl_share_setopt(share_, CURLSHOPT_SHARE, CURL_LOCK_DATA_COOKIE);
}
Cookies::~Cookies() { curl_share_cleanup(share_); }

std::expected<HttpResponse, Failure> Exchange(const HttpRequest& request, Cookies& cookies) {
  const std::unique_ptr<CURL, CurlFree> curl(curl_easy_init());
  Transfer transfer;
  transfer.max_bytes = request.max_bytes;
  CURL* handle = curl.get();
  curl_easy_setopt(handle, CURLOPT_URL, request.uri.c_str());
  curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(handle, CURLOPT_TIMEOUT_MS, static_cast<long>(request.timeout.count()));
  curl_easy_setopt(handle, CURLOPT_USERAGENT, request.user_agent.c_str());
  curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, &OnBody);
  curl_easy_setopt(handle, CURLOPT_WRITEDATA, &transfer);
  curl_easy_setopt(handle, CURLOPT_HEADERFUNCTION, &OnHeader);
  curl_easy_setopt(handle, CURLOPT_HEADERDATA, &transfer);
  curl_easy_setopt(handle, CURLOPT_ACCEPT_ENCODING, "");
  curl_easy_setopt(handle, CURLOPT_SHARE, cookies.share_);
  curl_easy_setopt(handle, CURLOPT_COOKIEFILE, "");  // no file, but the engine
  std::unique_ptr<curl_slist, CurlFree> headers;
  for (const std::string& line : request.headers) {
    headers.reset(curl_slist_append(headers.release(), line.c_str()));
  }
  curl_easy_setopt(handle, CURLOPT_HTTPHEADER, headers.get());
  std::string form;
  std::unique_ptr<curl_mime, CurlFree> mime;
  if (request.post && request.multipart) {
    mime.reset(curl_mime_init(handle));
    for (const Field& field : request.fields) {
      curl_mimepart* part = curl_mime_addpart(mime.get());
      curl_mime_name(part, field.name.c_str());
      curl_mime_data(part, field.value.data(), field.value.size());
      if (!field.content_type.empty()) curl_mime_type(part, field.content_type.c_str());
      if (!field.file_name.empty()) curl_mime_filename(part, field.file_name.c_str());
    }
    curl_easy_setopt(handle, CURLOPT_MIMEPOST, mime.get());
  } else if (request.post) {
    form = FormEncode(request.fields);
    curl_easy_setopt(handle, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(form.size()));
    curl_easy_setopt(handle, CURLOPT_POSTFIELDS, form.c_str());
  }
  const CURLcode done = curl_easy_perform(handle);
  ForgetTooMany(handle);
  if (done != CURLE_OK) {
    Failure failure;
    failure.code = done == CURLE_OPERATION_TIMEDOUT ? vm::Errc::kTimeout : vm::Errc::kUnavailable;
    failure.text = request.uri + ": " + curl_easy_strerror(done);
    if (transfer.too_long) {
      failure.code = vm::Errc::kTooLong;
      failure.text = request.uri + ": over " + std::to_string(request.max_bytes) + " bytes";
    }
    return std::unexpected(failure);
  }
  long status = 0;
  curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &status);
  transfer.response.status = static_cast<int>(status);
  return std::move(transfer.response);
}

}  // namespace vxml::fetch
