#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "agent_manager/routing/link.h"
#include "vm_protocol/runtime/stream_peer.h"

namespace am {

/// A Link over a StreamPeer.
class StreamLink final : public Link {
 public:
  /// `on_line`: hears each line that is sent; may be empty.
  explicit StreamLink(std::shared_ptr<vm::StreamPeer> peer,
                      std::function<void(const std::string&)> on_line = {})
      : peer_(std::move(peer)), on_line_(std::move(on_line)) {}
  ~StreamLink() override { peer_->Close(); }
  void Send(const Outgoing& outgoing) override {
    if (on_line_) on_line_(outgoing.line());
    peer_->Send(outgoing.line());
  }
  void SendComment(std::string_view text) override { peer_->Send(text); }
  void Close() override { peer_->Close(); }
  void WhenSent(std::function<void()> done) override { peer_->Flush(std::move(done)); }
  void PauseReading() override { peer_->PauseReading(); }
  void ResumeReading() override { peer_->ResumeReading(); }
  std::size_t backlog_bytes() const override { return peer_->backlog_bytes(); }

 private:
  std::shared_ptr<vm::StreamPeer> peer_;
  const std::function<void(const std::string&)> on_line_;
};

}  // namespace am
