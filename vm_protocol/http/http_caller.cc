#include "vm_protocol/http/http_caller.h"

#include <utility>

#include "vm_protocol/http/curl_handle.h"

namespace vm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLongestWaitMs = 50;  // between two looks at what has been cancelled

struct Exchange {
  const HttpRequest& request;
  HttpAnswer answer{};
  bool too_long = false;
  Clock::time_point last = Clock::now();  // when something came
};

std::size_t OnHeader(char* data, std::size_t size, std::size_t count, void* self) {
  auto& exchange = *static_cast<Exchange*>(self);
  exchange.last = Clock::now();
  AddHeaderLine({data, size * count}, exchange.answer.head);
  return size * count;
}

std::size_t OnBody(char* data, std::size_t size, std::size_t count, void* self) {
  auto& exchange = *static_cast<Exchange*>(self);
  exchange.last = Clock::now();
  exchange.too_long = exchange.answer.body.size() + size * count > exchange.request.max_bytes;
  if (exchange.too_long) return 0;  // ends the transfer
  exchange.answer.body.append(data, size * count);
  return size * count;
}

/// Takes the handle out of the loop, whatever happens.
class InLoop {
 public:
  InLoop(CURLM* multi, CURL* easy) : multi_(multi), easy_(easy) {
    curl_multi_add_handle(multi_, easy_);
  }
  ~InLoop() { curl_multi_remove_handle(multi_, easy_); }
  InLoop(const InLoop&) = delete;

 private:
  CURLM* const multi_;
  CURL* const easy_;
};

}  // namespace

struct HttpCaller::Impl {
  const std::string ca_file;
  const CurlMulti multi{curl_multi_init()};
  CurlShare cookies{};  // null: none are kept

  Result<HttpAnswer> Call(const HttpRequest& request, bool post, std::chrono::milliseconds stall,
                          const std::atomic<bool>& cancelled);
  void ForgetTooMany(CURL* handle) const;
};

HttpCaller::HttpCaller(std::string ca_file, bool cookies)
    : impl_((StartCurl(), new Impl{std::move(ca_file)})) {
  if (!cookies) return;
  impl_->cookies.reset(curl_share_init());
  curl_share_setopt(impl_->cookies.get(), CURLSHOPT_SHARE, CURL_LOCK_DATA_COOKIE);
}

HttpCaller::~HttpCaller() = default;

Result<HttpAnswer> HttpCaller::Post(const HttpRequest& request, std::chrono::milliseconds stall,
                                    const std::atomic<bool>& cancelled) {
  return impl_->Call(request, true, stall, cancelled);
}

Result<HttpAnswer> HttpCaller::Get(const HttpRequest& request, std::chrono::milliseconds stall,
                                   const std::atomic<bool>& cancelled) {
  return impl_->Call(request, false, stall, cancelled);
}

void HttpCaller::Impl::ForgetTooMany(CURL* handle) const {
  if (!cookies) return;
  curl_slist* known = nullptr;
  curl_easy_getinfo(handle, CURLINFO_COOKIELIST, &known);
  const CurlHeaders owner(known);
  std::size_t count = 0;
  for (const curl_slist* at = known; at != nullptr; at = at->next) ++count;
  if (count > kMaxCookies) curl_easy_setopt(handle, CURLOPT_COOKIELIST, "ALL");
}

Result<HttpAnswer> HttpCaller::Impl::Call(const HttpRequest& request, bool post,
                                          std::chrono::milliseconds stall,
                                          const std::atomic<bool>& cancelled) {
  const CurlHandle easy(curl_easy_init());
  const CurlHeaders headers = SetUpRequest(easy.get(), request, ca_file);
  if (!post) curl_easy_setopt(easy.get(), CURLOPT_HTTPGET, 1L);
  if (cookies) {
    curl_easy_setopt(easy.get(), CURLOPT_SHARE, cookies.get());
    curl_easy_setopt(easy.get(), CURLOPT_COOKIEFILE, "");  // no file, but the engine
  }
  Exchange exchange{request};
  curl_easy_setopt(easy.get(), CURLOPT_HEADERFUNCTION, &OnHeader);
  curl_easy_setopt(easy.get(), CURLOPT_HEADERDATA, &exchange);
  curl_easy_setopt(easy.get(), CURLOPT_WRITEFUNCTION, &OnBody);
  curl_easy_setopt(easy.get(), CURLOPT_WRITEDATA, &exchange);
  const InLoop in_loop(multi.get(), easy.get());
  while (true) {
    int running = 0, left = 0;
    curl_multi_perform(multi.get(), &running);
    if (const CURLMsg* const end = curl_multi_info_read(multi.get(), &left)) {
      ForgetTooMany(easy.get());
      if (exchange.too_long) return std::unexpected(TooLongAnswer(request));
      if (auto outcome = CurlOutcome(end->data.result); !outcome)
        return std::unexpected(outcome.error());
      long status = 0;
      curl_easy_getinfo(easy.get(), CURLINFO_RESPONSE_CODE, &status);
      exchange.answer.head.status = static_cast<int>(status);
      return std::move(exchange.answer);
    }
    if (cancelled) return Fail(Errc::kStopped, "stopped while the answer was waited for");
    if (Clock::now() - exchange.last > stall) {
      return Fail(Errc::kTimeout, "nothing has come for " + std::to_string(stall.count()) + " ms");
    }
    curl_multi_poll(multi.get(), nullptr, 0, kLongestWaitMs, nullptr);
  }
}

}  // namespace vm
