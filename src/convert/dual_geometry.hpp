#pragma once
// The drawing commands of a case of DualSPHysics.

#include <filesystem>
#include <vector>

#include "pieces.hpp"
#include "xml_reader.hpp"

namespace bedload {

/// What <geometry> draws, in order. Sets variables of the case as it goes. `folder`: to which files of meshes
/// become relative.
std::vector<Piece> drawn_pieces(XmlReader& xml, const pugi::xml_node& geometry,
                                const std::filesystem::path& folder);

/// Turns numbers like "3,5-7" into 3, 5, 6, 7.
std::vector<int> numbers_in(const XmlReader& xml, const pugi::xml_node& node, const char* attribute);

}  // namespace bedload
