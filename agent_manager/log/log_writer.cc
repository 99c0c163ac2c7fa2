#include "agent_manager/log/log_writer.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace am {
namespace {

constexpr std::size_t kBuffer = 64u << 10;
constexpr std::size_t kPiece = 64u << 10;           // compressed along with kBuffer written
constexpr std::uint64_t kMaxLogBytes = 256u << 20;  // read into memory by ReadLog

}  // namespace

LogWriter::LogWriter(const LogConfig& config, OnTrouble on_trouble)
    : config_(config), on_trouble_(std::move(on_trouble)) {
  std::error_code none;
  const auto old = std::filesystem::file_size(config_.file, none);
  if (!none && old > 0 && config_.rotate_mb > 0) Rotate();  // what was kept before stays
  if (file_ == nullptr && !Open(stuck_ ? "ae" : "we"))
    throw std::runtime_error("cannot write the session log '" + config_.file +
                             "': " + std::strerror(errno));
}

LogWriter::~LogWriter() {
  Flush();
  while (aside_ != nullptr) CompressSome(kPiece);
  if (file_ != nullptr) std::fclose(file_);
}

bool LogWriter::Open(const char* mode) {
  file_ = std::fopen(config_.file.c_str(), mode);
  size_ = 0;
  if (file_ == nullptr) return false;
  std::setvbuf(file_, nullptr, _IONBF, 0);  // the buffer is ours
  if (std::fseek(file_, 0, SEEK_END) == 0)
    size_ = static_cast<std::uint64_t>(std::max(std::ftell(file_), 0L));
  return true;
}

void LogWriter::Write(std::string_view line) {
  buffer_.append(line).push_back('\n');
  if (buffer_.size() >= kBuffer) Put();
}

void LogWriter::Flush() {
  if (!buffer_.empty()) Put();
}

void LogWriter::Put() {
  if (lost_since_ > 0)
    buffer_.insert(0, "# " + std::to_string(lost_since_) + " bytes could not be written here\n");
  if (file_ == nullptr) Open();
  if (file_ != nullptr && std::fwrite(buffer_.data(), 1, buffer_.size(), file_) == buffer_.size()) {
    size_ += buffer_.size();
    lost_since_ = 0;
  } else {
    if (lost_since_ == 0 && on_trouble_)
      on_trouble_("the session log '" + config_.file +
                  "' cannot be written: " + std::strerror(errno));
    lost_ += buffer_.size();
    lost_since_ += buffer_.size();
    if (file_ != nullptr) {  // no half lines
      std::clearerr(file_);
      static_cast<void>(!ftruncate(fileno(file_), static_cast<off_t>(size_)));
      std::fseek(file_, static_cast<long>(size_), SEEK_SET);
    }
  }
  buffer_.clear();
  CompressSome(4 * kPiece);
  if (config_.rotate_mb > 0 && size_ > config_.rotate_mb << 20 && aside_ == nullptr) Rotate();
}

/// The file has gone to where it is compressed from. What is open stays open.
bool LogWriter::PutAside() {
  const bool done = std::rename(config_.file.c_str(), Aside().c_str()) == 0;
  if (!done && !stuck_ && on_trouble_)
    on_trouble_("the session log '" + config_.file +
                "' cannot be put aside: " + std::strerror(errno));
  stuck_ = !done;
  return done;
}

/// Makes room for a new first one. False: it is where it was, and has to stay.
bool LogWriter::ShiftOld() {
  std::remove(Packed(config_.keep).c_str());
  for (unsigned i = config_.keep; i > 1; --i) {
    if (std::rename(Packed(i - 1).c_str(), Packed(i).c_str()) == 0 || errno == ENOENT) continue;
    if (on_trouble_)
      on_trouble_("cannot rename '" + Packed(i - 1) + "': " + std::strerror(errno) + "; '" +
                  Aside() + "' is not compressed");
    return false;
  }
  return true;
}

void LogWriter::Rotate() {
  if (!PutAside()) return;  // it grows on
  if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
  Open();
  if (config_.keep == 0) {
    std::remove(Aside().c_str());
    return;
  }
  if (!ShiftOld()) return;
  aside_ = std::fopen(Aside().c_str(), "re");
  packed_ = gzopen(Packed(1).c_str(), "wbe6");
  if (aside_ == nullptr || packed_ == nullptr) {
    if (on_trouble_) on_trouble_("cannot compress '" + Aside() + "': " + std::strerror(errno));
    EndCompressing();
  }
}

void LogWriter::CompressSome(std::size_t bytes) {
  if (aside_ == nullptr) return;
  std::array<char, kPiece> piece;
  for (std::size_t done = 0; done < bytes; done += piece.size()) {
    const std::size_t n = std::fread(piece.data(), 1, piece.size(), aside_);
    if (n > 0 && gzwrite(packed_, piece.data(), static_cast<unsigned>(n)) != static_cast<int>(n)) {
      // The plain file stays where it is until the next one takes its place.
      if (on_trouble_) on_trouble_("cannot compress '" + Aside() + "'");
      return EndCompressing();
    }
    if (n < piece.size()) {
      const bool whole = std::ferror(aside_) == 0;
      EndCompressing();
      if (whole) std::remove(Aside().c_str());
      return;
    }
  }
}

void LogWriter::EndCompressing() {
  if (aside_ != nullptr) std::fclose(std::exchange(aside_, nullptr));
  if (packed_ != nullptr) gzclose(std::exchange(packed_, nullptr));
}

std::string ReadLog(const std::string& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw std::runtime_error("'" + path + "' is no regular file");
  const gzFile file = gzopen(path.c_str(), "rbe");  // reads plain files as they are
  if (file == nullptr)
    throw std::runtime_error("cannot read '" + path + "': " + std::strerror(errno));
  std::string text;
  std::array<char, kPiece> piece;
  int n = 0;
  while ((n = gzread(file, piece.data(), static_cast<unsigned>(piece.size()))) > 0 &&
         text.size() <= kMaxLogBytes)
    text.append(piece.data(), static_cast<std::size_t>(n));
  int code = Z_OK;
  const std::string why = gzerror(file, &code);
  gzclose(file);
  if (n < 0) throw std::runtime_error("cannot read '" + path + "': " + why);
  if (text.size() > kMaxLogBytes)
    throw std::runtime_error("'" + path + "' holds more than " + std::to_string(kMaxLogBytes) +
                             " bytes");
  return text;
}

}  // namespace am
