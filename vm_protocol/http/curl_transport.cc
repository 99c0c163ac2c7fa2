#include "vm_protocol/http/curl_transport.h"

#include <curl/curl.h>

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "vm_protocol/http/curl_handle.h"

namespace vm {
namespace {

constexpr int kLongestSleepMs = 1000;

}  // namespace

/// One exchange, as both threads see it. What the thread of the network calls is `deliver`.
struct CurlTransport::Transfer {
  using Deliver = std::function<void(std::function<void(const HttpEvents&)>)>;

  HttpRequest request;
  HttpEvents events;  // the module's thread alone uses it
  Deliver deliver;
  std::atomic<bool> given_up = false;

  CurlHandle easy{curl_easy_init()};
  CurlHeaders headers;
  HttpHead head;
  bool head_told = false;
  std::size_t bytes = 0;
  bool too_long = false;

  void SetUp(const std::string& ca_file);
  void TellHead();
  vm::Result<void> EndOf(CURLcode code) const;
  static std::size_t OnHeader(char* data, std::size_t size, std::size_t count, void* self);
  static std::size_t OnBody(char* data, std::size_t size, std::size_t count, void* self);
};

std::size_t CurlTransport::Transfer::OnHeader(char* data, std::size_t size, std::size_t count,
                                              void* self) {
  AddHeaderLine({data, size * count}, static_cast<Transfer*>(self)->head);
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

void CurlTransport::Transfer::SetUp(const std::string& ca_file) {
  CURL* const handle = easy.get();
  headers = SetUpRequest(handle, request, ca_file);
  curl_easy_setopt(handle, CURLOPT_HEADERFUNCTION, &OnHeader);
  curl_easy_setopt(handle, CURLOPT_HEADERDATA, this);
  curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, &OnBody);
  curl_easy_setopt(handle, CURLOPT_WRITEDATA, this);
  curl_easy_setopt(handle, CURLOPT_PRIVATE, this);
}

vm::Result<void> CurlTransport::Transfer::EndOf(CURLcode code) const {
  if (too_long) return std::unexpected(TooLongAnswer(request));
  return CurlOutcome(code);
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

  const CurlMulti multi_{curl_multi_init()};
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
                             std::function<bool()> real, std::string ca_file)
    : io_(io), clock_(clock), real_(std::move(real)), ca_file_(std::move(ca_file)) {
  StartCurl();
}

CurlTransport::~CurlTransport() = default;

std::unique_ptr<HttpExchange> CurlTransport::Post(HttpRequest request, HttpEvents events) {
  const auto transfer = std::make_shared<Transfer>();
  transfer->request = std::move(request);
  transfer->events = std::move(events);
  transfer->SetUp(ca_file_);
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

}  // namespace vm
