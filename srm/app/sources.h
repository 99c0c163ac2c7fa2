#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>

#include "srm/core/audio_source.h"

namespace srm {

/// A source by its name:
///   wav:PATH              a recording; see RecordedSource
///   raw:PATH              16 kHz 16 bit mono little endian from a pipe, FIFO or device, as it
///   comes portaudio[:NAME]      a microphone by a part of its name; the default one without
/// Errors: kBadValue (another name), kUnavailable (cannot be opened), kUnavailable for live sources
/// on a clock that is not `real`.
vm::Result<std::unique_ptr<AudioSource>> OpenSource(const std::string& name,
                                                    vm::Scheduler& scheduler,
                                                    boost::asio::io_context& io, bool real);

/// Part of OpenSource; portaudio_source.cc.
vm::Result<std::unique_ptr<AudioSource>> OpenMicrophone(const std::string& device,
                                                        vm::Scheduler& scheduler);

}  // namespace srm
