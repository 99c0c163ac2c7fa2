#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vm_protocol/http/http.h"

namespace chat_test {

/// The network, played by a test: what is asked is kept, and the test answers when it likes.
class FakeTransport final : public vm::HttpTransport {
 public:
  struct Call {
    vm::HttpRequest request;
    vm::HttpEvents events;
    bool open = true;
  };

  std::unique_ptr<vm::HttpExchange> Post(vm::HttpRequest request, vm::HttpEvents events) override {
    calls.push_back(std::make_shared<Call>(Call{std::move(request), std::move(events)}));
    return std::make_unique<Exchange>(calls.back());
  }
  Call& last() { return *calls.back(); }

  void Head(int status,
            std::map<std::string, std::string> headers = {{"content-type", "text/event-stream"}}) {
    if (last().open) last().events.on_head({status, std::move(headers)});
  }
  void Data(const std::string& bytes) {
    if (last().open) last().events.on_data(bytes);
  }
  void End(vm::Result<void> end = {}) {
    if (last().open) last().events.on_end(end);
  }
  void Words(const std::string& words) {
    Data("data: {\"choices\":[{\"delta\":{\"content\":\"" + words + "\"}}]}\n\n");
  }
  void Done() { Data("data: [DONE]\n\n"); }

  std::vector<std::shared_ptr<Call>> calls;

 private:
  struct Exchange final : vm::HttpExchange {
    explicit Exchange(std::shared_ptr<Call> of) : call(std::move(of)) {}
    ~Exchange() override { call->open = false; }
    std::shared_ptr<Call> call;
  };
};

}  // namespace chat_test
