#pragma once
// Ctrl-C and SIGTERM end a run after the step at hand. A second Ctrl-C ends it at once.

namespace bedload {

/// The user stopped the program where nothing is worth saving.
struct Stopped {};

/// Catches both signals from now on.
void watch_signals();
bool stop_requested();

}  // namespace bedload
