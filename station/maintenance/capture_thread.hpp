#pragma once
#include <functional>
#include <memory>
#include <thread>

#include "station/drive/alsa_capture.hpp"

namespace turnpoint::maintenance {

/// Passes everything that a sound device captures to a function, on an ordinary thread of its own.
class CaptureThread {
 public:
  using OnBlock = std::function<void(const drive::CapturedBlock&)>;

  /// Throws the errors of drive::open_capture().
  CaptureThread(const drive::OutputConfig& device, OnBlock on_block);

  /// Ends the thread, after everything that was captured until now has been passed on. Throws
  /// std::runtime_error if the device was disconnected.
  drive::CaptureCounters end();

 private:
  void take();

  const drive::OutputConfig device_;
  OnBlock on_block_;
  std::unique_ptr<drive::Capture> capture_;
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread thread_;
};

}  // namespace turnpoint::maintenance
