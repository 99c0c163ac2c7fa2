// The module that moves avatars of other programs: options, a socket, and the module over them.

#include <CLI/CLI.hpp>
#include <boost/asio/ip/udp.hpp>
#include <charconv>
#include <memory>
#include <stdexcept>
#include <string>

#include "gateway/vmc/vmc_module.h"
#include "vm_protocol/runtime/asio_scheduler.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

namespace asio = boost::asio;

/// Sends datagrams to one place. Nothing waits: what the system does not take at once is lost.
class Sender {
 public:
  explicit Sender(asio::io_context& io) : io_(io), socket_(io) {}

  vm::Result<void> Aim(const std::string& to) {
    const std::size_t colon = to.rfind(':');
    unsigned port = 0;
    const char* const end = to.data() + to.size();
    if (colon == std::string::npos || colon == 0 ||
        std::from_chars(to.data() + colon + 1, end, port).ptr != end || port == 0 ||
        port > 65'535) {
      return vm::Fail(vm::Errc::kBadValue, "'" + to + "' found, HOST:PORT expected");
    }
    std::string host = to.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    if (host == "localhost") host = "127.0.0.1";
    boost::system::error_code error;
    const auto address = asio::ip::make_address(host, error);
    if (error) {
      return vm::Fail(vm::Errc::kBadValue, "'" + host + "' is no address; names are not looked up");
    }
    asio::ip::udp::socket socket(io_);
    const asio::ip::udp::endpoint place(address, static_cast<unsigned short>(port));
    socket.open(place.protocol(), error);
    if (!error) socket.non_blocking(true, error);
    if (error) return vm::Fail(vm::Errc::kUnavailable, "no socket: " + error.message());
    socket_ = std::move(socket);
    place_ = place;
    return {};
  }
  bool Send(const std::string& bytes) {
    boost::system::error_code error;
    socket_.send_to(asio::buffer(bytes), place_, 0, error);
    return !error;
  }

 private:
  asio::io_context& io_;
  asio::ip::udp::socket socket_;
  asio::ip::udp::endpoint place_;
};

/// The module with its socket, in order of construction.
class Program final : public vm::Module {
 public:
  Program(vm::ClockScheduler& clock, asio::io_context& io, const std::string& to)
      : sender_(io),
        module_(clock, {.module_version = "Galatea VMC " GALATEA_VERSION,
                        .to = to,
                        .real = [&clock] { return clock.real(); },
                        .aim = [this](const std::string& place) { return sender_.Aim(place); },
                        .send = [this](const std::string& bytes) { return sender_.Send(bytes); }}) {
    if (auto aimed = sender_.Aim(to); !aimed)
      throw std::runtime_error("--to: " + aimed.error().text);
  }
  vm::SlotMachine& slots() override { return module_.slots(); }
  bool Busy() const override { return module_.Busy(); }
  bool ExitRequested() const override { return module_.ExitRequested(); }
  void Shutdown() override { module_.Shutdown(); }

 private:
  Sender sender_;
  gateway::VmcModule module_;
};

}  // namespace

int main(int argc, char** argv) {
  std::string to = "127.0.0.1:39539";
  return vm::RunModule(
      argc, argv,
      {.name = "vmc",
       .description =
           "Moves avatars of other programs (VSeeFace, Warudo, ...) as the face moves, by VMC",
       .module_name = "VMC",
       .virtual_by_default = true,
       .add_options =
           [&to](CLI::App& app) {
             app.add_option("--to", to, "Where bundles go, HOST:PORT (127.0.0.1:39539)");
           },
       .make =
           [&to](vm::Scheduler& scheduler, asio::io_context& io) {
             return std::make_unique<Program>(dynamic_cast<vm::ClockScheduler&>(scheduler), io, to);
           }});
}
