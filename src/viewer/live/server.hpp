#pragma once
// Serves the live view of a run to browsers on this machine.

#include <memory>
#include <string>

#include "view.hpp"

namespace bedload {

/// Serves a view on 127.0.0.1 only, until destroyed; then open pages get a moment to fetch the last state.
/// Answers only GET with a Host header of this machine, so that no web site can read it by another name (DNS
/// rebinding), and serves no files.
class LiveServer {
 public:
  static constexpr int kDefaultPort = 8020, kLeastPort = 1024, kMostPort = 65535;

  /// port: 0 for any free one. `name`: of the case. Throws CaseError if the port is in use.
  LiveServer(int port, std::string name);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  LiveView& view();
  /// "http://127.0.0.1:8020"
  std::string address() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bedload
