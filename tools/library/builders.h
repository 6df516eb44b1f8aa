#pragma once

#include <vector>

#include "part.h"

/// The elements of the library by kind. Each call makes its solids anew.
namespace dowel::library {

std::vector<Part> base_plates();
std::vector<Part> risers();
std::vector<Part> spacers();
std::vector<Part> columns();
std::vector<Part> rest_pads();
std::vector<Part> rest_buttons();
std::vector<Part> edge_locators();
std::vector<Part> locating_pins();
std::vector<Part> pin_holders();
std::vector<Part> vee_blocks();
std::vector<Part> straps();
std::vector<Part> heel_screws();
std::vector<Part> studs();
std::vector<Part> socket_screws();
std::vector<Part> fit_screws();
std::vector<Part> nuts();
std::vector<Part> washers();
std::vector<Part> dowel_pins();
std::vector<Part> workpieces();

/// All of them, in the order of the manifest.
std::vector<Part> all_parts();

}  // namespace dowel::library
