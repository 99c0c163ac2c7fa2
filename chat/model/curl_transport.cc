#include "chat/model/curl_transport.h"

#include <curl/curl.h>

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "vm_protocol/core/lower_case.h"

namespace chat {
namespace {

constexpr int kLongestSleepMs = 1000;
constexpr std::size_t kMaxHeaders = 100;

struct CurlFree {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

struct MultiFree {
  void operator()(CURLM* handle) const { curl_multi_cleanup(handle); }
};

/// Names of this machine: they are reached directly, whatever proxy the environment names.
bool IsHere(const std::string& url) {
  for (const char* place : {"://127.", "://localhost", "://[::1]"}) {
    if (url.find(place) < 8) return true;
  }
  return false;
}

}  // namespace

/// One exchange, as both threads see it. What the thread of the network calls is `deliver`.
struct CurlTransport::Transfer {
  using Deliver = std::function<void(std::function<void(const HttpEvents&)>)>;

  HttpRequest request;
  HttpEvents events;  // the module's thread alone uses it
  Deliver deliver;
  std::atomic<bool> given_up = false;

  std::unique_ptr<CURL, CurlFree> easy{curl_easy_init()};
  std::unique_ptr<curl_slist, CurlFree> headers;
  HttpHead head;
  bool head_told = false;
  std::size_t bytes = 0;
  bool too_long = false;

  void SetUp();
  void TellHead();
  vm::Result<void> EndOf(CURLcode code) const;
  static std::size_t OnHeader(char* data, std::size_t size, std::size_t count, void* self);
  static std::size_t OnBody(char* data, std::size_t size, std::size_t count, void* self);
};

std::size_t CurlTransport::Transfer::OnHeader(char* data, std::size_t size, std::size_t count,
                                              void* self) {
  HttpHead& head = static_cast<Transfer*>(self)->head;
  const std::string_view line(data, size * count);
  if (line.starts_with("HTTP/")) head.headers.clear();
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || head.headers.size() >= kMaxHeaders) return size * count;
  std::string_view value = line.substr(colon + 1);
  value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
  value = value.substr(0, value.find_last_not_of(" \t\r\n") + 1);
  head.headers[vm::LowerCase(line.substr(0, colon))] = value;
  return size * count;
}

void CurlTransport::Transfer::TellHead() {
  if (std::exchange(head_told, true)) return;
  long status = 0;
  curl_easy_getinfo(easy.get(), CURLINFO_RESPONSE_CODE, &status);
  head.status = static_cast<int>(status);
  deliver([told = head](const HttpEvents& to) { to.on_head(told); });
}

std::size_t CurlTransport::Transfer::OnBody(char* data, std::size_t size, std::size_t count,
                                            void* self) {
  auto& transfer = *static_cast<Transfer*>(self);
  transfer.bytes += size * count;
  transfer.too_long = transfer.bytes > transfer.request.max_bytes;
  if (transfer.too_long || transfer.given_up) return 0;  // ends the transfer
  transfer.TellHead();
  transfer.deliver(
      [bytes = std::string(data, size * count)](const HttpEvents& to) { to.on_data(bytes); });
  return size * count;
}

void CurlTransport::Transfer::SetUp() {
  CURL* const handle = easy.get();
  if (handle == nullptr) throw std::runtime_error("libcurl gives no handle");
  curl_easy_setopt(handle, CURLOPT_URL, request.url.c_str());
  curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(handle, CURLOPT_TIMEOUT_MS, static_cast<long>(request.limit.count()));
  curl_easy_setopt(handle, CURLOPT_USERAGENT, "Galatea/" GALATEA_VERSION);
  curl_easy_setopt(handle, CURLOPT_TCP_NODELAY, 1L);
  if (IsHere(request.url)) curl_easy_setopt(handle, CURLOPT_PROXY, "");
  for (const std::string& line : request.headers)
    headers.reset(curl_slist_append(headers.release(), line.c_str()));
  // Without this a body of more than 1 KiB waits for "100 Continue".
  headers.reset(curl_slist_append(headers.release(), "Expect:"));
  curl_easy_setopt(handle, CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(handle, CURLOPT_POSTFIELDSIZE_LARGE,
                   static_cast<curl_off_t>(request.body.size()));
  curl_easy_setopt(handle, CURLOPT_POSTFIELDS, request.body.c_str());
  curl_easy_setopt(handle, CURLOPT_HEADERFUNCTION, &OnHeader);
  curl_easy_setopt(handle, CURLOPT_HEADERDATA, this);
  curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, &OnBody);
  curl_easy_setopt(handle, CURLOPT_WRITEDATA, this);
  curl_easy_setopt(handle, CURLOPT_PRIVATE, this);
}

vm::Result<void> CurlTransport::Transfer::EndOf(CURLcode code) const {
  if (too_long) {
    return vm::Fail(vm::Errc::kTooLong,
                    "the answer has more than " + std::to_string(request.max_bytes) + " bytes");
  }
  if (code == CURLE_OK) return {};
  return vm::Fail(code == CURLE_OPERATION_TIMEDOUT ? vm::Errc::kTimeout : vm::Errc::kUnavailable,
                  curl_easy_strerror(code));
}

/// The thread that carries exchanges.
class CurlTransport::Loop {
 public:
  Loop() : thread_([this] { Run(); }) {}
  ~Loop() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    Wake();
    thread_.join();
  }
  void Add(std::shared_ptr<Transfer> transfer) {
    {
      const std::lock_guard lock(mutex_);
      added_.push_back(std::move(transfer));
    }
    Wake();
  }
  void Wake() { curl_multi_wakeup(multi_.get()); }

 private:
  void Run() {
    while (TakeOrders()) {
      int running = 0;
      curl_multi_perform(multi_.get(), &running);
      TakeEnded();
      curl_multi_poll(multi_.get(), nullptr, 0, kLongestSleepMs, nullptr);
    }
    for (const auto& transfer : active_)
      curl_multi_remove_handle(multi_.get(), transfer->easy.get());
  }
  bool TakeOrders() {
    std::deque<std::shared_ptr<Transfer>> added;
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return false;
      added.swap(added_);
    }
    for (auto& transfer : added) {
      curl_multi_add_handle(multi_.get(), transfer->easy.get());
      active_.push_back(std::move(transfer));
    }
    std::erase_if(active_, [this](const auto& transfer) {
      if (!transfer->given_up) return false;
      curl_multi_remove_handle(multi_.get(), transfer->easy.get());
      return true;
    });
    return true;
  }
  void TakeEnded() {
    int left = 0;
    while (const CURLMsg* const message = curl_multi_info_read(multi_.get(), &left)) {
      if (message->msg != CURLMSG_DONE) continue;
      CURL* const easy = message->easy_handle;
      const CURLcode code = message->data.result;
      curl_multi_remove_handle(multi_.get(), easy);
      std::erase_if(active_, [easy, code](const auto& transfer) {
        if (transfer->easy.get() != easy) return false;
        if (code == CURLE_OK) transfer->TellHead();
        transfer->deliver([end = transfer->EndOf(code)](const HttpEvents& to) { to.on_end(end); });
        return true;
      });
    }
  }

  const std::unique_ptr<CURLM, MultiFree> multi_{curl_multi_init()};
  std::deque<std::shared_ptr<Transfer>> active_;  // the thread's own
  std::mutex mutex_;
  std::deque<std::shared_ptr<Transfer>> added_;  // guarded by the mutex
  bool stopping_ = false;                        // guarded by the mutex
  std::thread thread_;
};

namespace {

/// Nothing comes of a transfer once this has gone.
class CurlExchange final : public HttpExchange {
 public:
  CurlExchange(std::shared_ptr<CurlTransport::Transfer> transfer, std::function<void()> wake)
      : transfer_(std::move(transfer)), wake_(std::move(wake)) {}
  ~CurlExchange() override {
    transfer_->given_up = true;
    wake_();
  }

 private:
  const std::shared_ptr<CurlTransport::Transfer> transfer_;
  const std::function<void()> wake_;
};

}  // namespace

CurlTransport::CurlTransport(boost::asio::io_context& io, vm::Scheduler& clock,
                             std::function<bool()> real)
    : io_(io), clock_(clock), real_(std::move(real)) {
  curl_global_init(CURL_GLOBAL_DEFAULT);
}

CurlTransport::~CurlTransport() {
  loop_.reset();
  curl_global_cleanup();
}

std::unique_ptr<HttpExchange> CurlTransport::Post(HttpRequest request, HttpEvents events) {
  const auto transfer = std::make_shared<Transfer>();
  transfer->request = std::move(request);
  transfer->events = std::move(events);
  transfer->SetUp();
  const auto give = [](const std::shared_ptr<Transfer>& to, const auto& event) {
    if (!to->given_up) event(to->events);
  };
  if (!real_()) {
    std::deque<std::function<void(const HttpEvents&)>> came;
    transfer->deliver = [&came](auto event) { came.push_back(std::move(event)); };
    const CURLcode code = curl_easy_perform(transfer->easy.get());
    if (code == CURLE_OK) transfer->TellHead();
    came.push_back([end = transfer->EndOf(code)](const HttpEvents& told) { told.on_end(end); });
    transfer->deliver = {};
    for (auto& event : came) {
      clock_.Post([give, transfer, event = std::move(event)] { give(transfer, event); });
    }
    return std::make_unique<CurlExchange>(transfer, [] {});
  }
  // The guard lets the context run on while something may come.
  const auto work = boost::asio::make_work_guard(io_);
  transfer->deliver = [this, work, give, weak = std::weak_ptr<Transfer>(transfer)](auto event) {
    const auto to = weak.lock();
    if (!to) return;
    boost::asio::post(io_, [give, to, event = std::move(event)] { give(to, event); });
  };
  if (!loop_) loop_ = std::make_unique<Loop>();
  loop_->Add(transfer);
  return std::make_unique<CurlExchange>(transfer, [this] { loop_->Wake(); });
}

}  // namespace chat
