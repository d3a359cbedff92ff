#pragma once
// Numbers with a unit: "3 mm", "90 rpm", "50 ml/min".

#include <string>
#include <string_view>

namespace bedload {

/// Whether values in `unit` may be written with another unit: not fractions, nor multiples of a length
/// of the case.
bool takes_units(std::string_view unit);

/// `text`, a number and its unit, as a number in `unit` ("m3/s"). Factors of a unit follow each other or
/// stand behind "/", each with its power: "kg/m3", "Pa s", "m s-2", "m/s^2". A unit of powers of ten gives
/// the very number that the digits would: "2.7 mm" is 0.0027. Throws CaseError that states what is wrong, as
/// the rest of a sentence.
double quantity(std::string_view text, std::string_view unit);

}  // namespace bedload
