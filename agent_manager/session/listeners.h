#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "agent_manager/config/config.h"
#include "agent_manager/routing/hub.h"
#include "vm_protocol/runtime/acceptor.h"

namespace am {

/// The places where clients and modules come in. Thread: the context's.
class Listeners {
 public:
  using OnNotice = std::function<void(const std::string& text)>;
  Listeners(boost::asio::io_context& io, Hub& hub, OnNotice on_notice, OnNotice on_refusal);

  using Open = std::vector<std::pair<ListenConfig, std::unique_ptr<vm::Acceptor>>>;
  /// Opens those of `wanted` that are not open yet. Throws std::runtime_error with a sentence if
  /// one cannot be had; then none of them is.
  Open OpenMissing(const std::vector<ListenConfig>& wanted);
  /// Keeps what is wanted, closes the rest, and takes `opened`.
  void Commit(const std::vector<ListenConfig>& wanted, Open opened);
  void CloseAll() { open_.clear(); }

 private:
  void OnConnection(const vm::Acceptor::Connection& connection, Role role);

  boost::asio::io_context& io_;
  Hub& hub_;
  OnNotice on_notice_, on_refusal_;
  Open open_;
};

}  // namespace am
