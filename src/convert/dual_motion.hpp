#pragma once
// Motions and floating bodies of a case of DualSPHysics.

#include "pieces.hpp"
#include "xml_reader.hpp"

namespace bedload {

/// Adds [wall.body.motion] of each mk that <motion> moves to `keys`. `end`: the last time, s.
void read_motions(XmlReader& xml, const pugi::xml_node& motion, double end, BodyKeys& keys);

/// Adds [wall.body.motion] of pistons and flaps in <wavepaddles>.
void read_paddles(XmlReader& xml, const pugi::xml_node& paddles, BodyKeys& keys);

/// Adds [wall.body.free] of each mk in <floatings>; `release`: s at which they are let go.
void read_floatings(XmlReader& xml, const pugi::xml_node& floatings, double release, BodyKeys& keys);

}  // namespace bedload
