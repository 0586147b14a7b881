// SPDX-License-Identifier: GPL-3.0-or-later
#include "volumes/stiv_sums.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace stiv {

StivSums::StivSums(const std::vector<Index>& labels)
    : stivs_(labels.empty() ? 0 : static_cast<std::size_t>(*std::max_element(labels.begin(), labels.end())) + 1) {}

std::vector<Stiv> StivSums::stivs() {
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.patch, a.vertex) < std::tie(b.patch, b.vertex);
  });
  for (const Entry& entry : entries_) {
    SparseField& field = stivs_[at(entry.patch)].gradient;
    if (!field.index.empty() && field.index.back() == entry.vertex) {
      field.value.back() += entry.value;
    } else {
      field.index.push_back(entry.vertex);
      field.value.push_back(entry.value);
    }
  }
  return std::move(stivs_);
}

}  // namespace stiv
