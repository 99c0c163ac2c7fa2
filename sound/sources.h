#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>

#include "sound/audio_source.h"

namespace sound {

/// A source by its name:
///   wav:PATH              a recording; see RecordedSource
///   raw[@RATE]:PATH       16 bit mono little endian from a pipe, FIFO or device, as it comes; - is
///                         standard input (for a module that is spoken to over a socket)
///   tcp[@RATE]:PORT       the same from whoever connects to the port of this machine, one after
///   unix[@RATE]:PATH      the other; or to a socket in the file system
///   portaudio[:NAME]      a microphone by a part of its name; the default one without
/// RATE is in Hz, 16000 without; other rates are resampled.
/// Errors: kBadValue (another name), kUnavailable (cannot be opened), kUnavailable for live sources
/// on a clock that is not `real`.
vm::Result<std::unique_ptr<AudioSource>> OpenSource(const std::string& name,
                                                    vm::Scheduler& scheduler,
                                                    boost::asio::io_context& io, bool real);

/// Parts of OpenSource; portaudio_source.cc, stream_source.cc.
vm::Result<std::unique_ptr<AudioSource>> OpenMicrophone(const std::string& device,
                                                        vm::Scheduler& scheduler);
/// `kind` is raw, tcp or unix.
vm::Result<std::unique_ptr<AudioSource>> OpenStream(const std::string& kind,
                                                    const std::string& place, unsigned rate_hz,
                                                    boost::asio::io_context& io);

}  // namespace sound
