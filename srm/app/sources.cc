#include "srm/app/sources.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <cstring>
#include <utility>

#include "srm/engine/sound_file.h"

namespace srm {
namespace {

/// Bytes of a pipe as they come. A FIFO is held open for writing too, so that it outlives writers.
class PipeSource final : public AudioSource {
 public:
  PipeSource(boost::asio::io_context& io, int fd) : pipe_(io, fd) {}
  ~PipeSource() override { *alive_ = false; }

  vm::Result<void> Start(Events events) override {
    events_ = std::move(events);
    Read();
    return {};
  }
  bool Ends() const override { return false; }

 private:
  void Read() {
    pipe_.async_read_some(boost::asio::buffer(bytes_.data() + kept_, bytes_.size() - kept_),
                          [this, alive = alive_](boost::system::error_code error, std::size_t n) {
                            if (*alive) OnRead(error, n);
                          });
  }
  void OnRead(boost::system::error_code error, std::size_t n) {
    if (error == boost::asio::error::eof) return events_.ended();
    if (error) return events_.failed({vm::Errc::kUnavailable, "sound pipe: " + error.message(), 0});
    n += kept_;
    std::vector<std::int16_t> samples(n / 2);
    std::memcpy(samples.data(), bytes_.data(), samples.size() * 2);
    kept_ = n % 2;
    if (kept_ == 1) bytes_[0] = bytes_[n - 1];
    const auto alive = alive_;
    if (!samples.empty()) events_.sound(samples);
    if (*alive) Read();
  }

  boost::asio::posix::stream_descriptor pipe_;
  Events events_;
  std::array<char, 8192> bytes_{};
  std::size_t kept_ = 0;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

}  // namespace

vm::Result<std::unique_ptr<AudioSource>> OpenSource(const std::string& name,
                                                    vm::Scheduler& scheduler,
                                                    boost::asio::io_context& io, bool real) {
  if (name.starts_with("wav:")) {
    auto samples = ReadSound(name.substr(4));
    if (!samples) return std::unexpected(samples.error());
    return std::make_unique<RecordedSource>(scheduler, std::move(*samples));
  }
  const bool raw = name.starts_with("raw:") && name.size() > 4;
  const bool microphone = name == "portaudio" || name.starts_with("portaudio:");
  if (!raw && !microphone) {
    return vm::Fail(
        vm::Errc::kBadValue,
        "found '" + name + "', expected NONE, wav:PATH, raw:PATH or portaudio[:DEVICE]");
  }
  if (!real) {
    return vm::Fail(vm::Errc::kUnavailable, "'" + name + "' needs the real clock (--clock real)");
  }
  if (microphone) return OpenMicrophone(name.size() > 10 ? name.substr(10) : "", scheduler);
  const std::string path = name.substr(4);
  const int fd = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot open '" + path + "': " + std::strerror(errno));
  }
  return std::make_unique<PipeSource>(io, fd);
}

}  // namespace srm
