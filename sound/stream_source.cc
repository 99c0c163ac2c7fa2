// Bytes of sound as they come: from a pipe, standard input, or whoever connects to a socket.

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>

#include "sound/sound_file.h"
#include "sound/sources.h"

namespace sound {
namespace {

namespace asio = boost::asio;

/// Little-endian samples out of bytes in pieces of any size, at the ear's rate.
class ByteSamples {
 public:
  explicit ByteSamples(unsigned rate_hz) : resampler_(rate_hz) {}
  std::vector<std::int16_t> Take(const char* bytes, std::size_t count) {
    kept_.append(bytes, count);
    std::vector<std::int16_t> samples(kept_.size() / 2);
    std::memcpy(samples.data(), kept_.data(), samples.size() * 2);
    kept_.erase(0, samples.size() * 2);
    return resampler_.Add(samples);
  }

 private:
  StreamResampler resampler_;
  std::string kept_;  // less than a sample
};

/// A FIFO is held open for writing too, so that it outlives writers.
template <class Stream>
class StreamReader {
 public:
  StreamReader(Stream stream, unsigned rate_hz) : stream_(std::move(stream)), samples_(rate_hz) {}
  ~StreamReader() { *alive_ = false; }
  void Read(std::function<void(std::span<const std::int16_t>)> sound,
            std::function<void(boost::system::error_code)> over) {
    sound_ = std::move(sound);
    over_ = std::move(over);
    Next();
  }

 private:
  void Next() {
    stream_.async_read_some(asio::buffer(bytes_),
                            [this, alive = alive_](boost::system::error_code error, std::size_t n) {
                              if (!*alive) return;
                              if (error) return over_(error);
                              const auto samples = samples_.Take(bytes_.data(), n);
                              if (!samples.empty()) sound_(samples);
                              if (*alive) Next();
                            });
  }
  Stream stream_;
  ByteSamples samples_;
  std::array<char, 8192> bytes_{};
  std::function<void(std::span<const std::int16_t>)> sound_;
  std::function<void(boost::system::error_code)> over_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

class PipeSource final : public AudioSource {
 public:
  PipeSource(asio::io_context& io, int fd, unsigned rate_hz)
      : reader_(asio::posix::stream_descriptor(io, fd), rate_hz) {}
  vm::Result<void> Start(Events events) override {
    events_ = std::move(events);
    reader_.Read(events_.sound, [this](boost::system::error_code error) {
      if (error == asio::error::eof) return events_.ended();
      events_.failed({vm::Errc::kUnavailable, "sound pipe: " + error.message(), 0});
    });
    return {};
  }
  bool Ends() const override { return false; }

 private:
  StreamReader<asio::posix::stream_descriptor> reader_;
  Events events_;
};

/// Listens; one client at a time is heard, the next one when it has gone.
template <class Protocol>
class SocketSource final : public AudioSource {
 public:
  SocketSource(asio::io_context& io, const typename Protocol::endpoint& where, unsigned rate_hz)
      : acceptor_(io, where), rate_hz_(rate_hz) {}
  ~SocketSource() override { *alive_ = false; }
  vm::Result<void> Start(Events events) override {
    events_ = std::move(events);
    Accept();
    return {};
  }
  bool Ends() const override { return false; }

 private:
  using Socket = typename Protocol::socket;
  void Accept() {
    acceptor_.async_accept([this, alive = alive_](boost::system::error_code error, Socket socket) {
      if (!*alive) return;
      if (error) return events_.failed({vm::Errc::kUnavailable, "sound: " + error.message(), 0});
      reader_ = std::make_unique<StreamReader<Socket>>(std::move(socket), rate_hz_);
      reader_->Read(events_.sound, [this](boost::system::error_code) { Accept(); });
    });
  }
  typename Protocol::acceptor acceptor_;
  const unsigned rate_hz_;
  std::unique_ptr<StreamReader<Socket>> reader_;
  Events events_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

std::unexpected<vm::Error> CannotOpen(const std::string& place, const std::string& why) {
  return vm::Fail(vm::Errc::kUnavailable, "cannot open '" + place + "': " + why);
}

vm::Result<std::unique_ptr<AudioSource>> OpenPipe(const std::string& place, unsigned rate_hz,
                                                  asio::io_context& io) {
  const int fd =
      place == "-" ? dup(STDIN_FILENO) : open(place.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return CannotOpen(place, std::strerror(errno));
  try {
    return std::make_unique<PipeSource>(io, fd, rate_hz);
  } catch (const boost::system::system_error& error) {  // a plain file cannot be waited for
    close(fd);
    return CannotOpen(place, error.code().message() + "; wav: reads files");
  }
}

}  // namespace

vm::Result<std::unique_ptr<AudioSource>> OpenStream(const std::string& kind,
                                                    const std::string& place, unsigned rate_hz,
                                                    asio::io_context& io) {
  if (kind == "raw") return OpenPipe(place, rate_hz, io);
  try {
    if (kind == "unix") {
      // What is left of a socket of before is in the way; anything else stays.
      if (std::filesystem::is_socket(place)) std::filesystem::remove(place);
      using Local = asio::local::stream_protocol;
      return std::make_unique<SocketSource<Local>>(io, Local::endpoint(place), rate_hz);
    }
    unsigned short port = 0;
    const char* end = place.data() + place.size();
    const auto [rest, error] = std::from_chars(place.data(), end, port);
    if (error != std::errc() || rest != end || port == 0) {
      return vm::Fail(vm::Errc::kBadValue, "found '" + place + "', expected a port, 1 to 65535");
    }
    using Tcp = asio::ip::tcp;
    const Tcp::endpoint where(asio::ip::address_v4::loopback(), port);
    return std::make_unique<SocketSource<Tcp>>(io, where, rate_hz);
  } catch (const boost::system::system_error& error) {
    return CannotOpen(place, error.code().message());
  }
}

}  // namespace sound
