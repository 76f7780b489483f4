// Numbers the distinct vertices of some rows by their order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "app/verify/buffer.hpp"

namespace flaunay::prove {

/// A set of ids of a range, with the number of smaller ids in the set for each of them. A block of 384 ids
/// fills a cache line, so that each question reads one.
class VertexIndex {
 public:
  static constexpr std::uint64_t kBlockIds = 384;

  /// For ranges of at most `ids`.
  explicit VertexIndex(std::uint64_t ids) : blocks_(ids / kBlockIds + 1) {}

  std::uint64_t capacity() const { return blocks_.size() * kBlockIds; }

  /// The empty set, for the ids [first, first + count).
  void clear(std::uint64_t first, std::uint64_t count) {
    first_ = first;
    used_blocks_ = static_cast<std::size_t>((count + kBlockIds - 1) / kBlockIds);
    std::fill_n(blocks_.data(), used_blocks_, Block{});
  }
  void insert(std::uint64_t id) {
    const std::uint64_t place = id - first_;
    const std::uint64_t in_block = place % kBlockIds;
    blocks_[place / kBlockIds].words[in_block / 64] |= std::uint64_t{1} << in_block % 64;
  }
  /// Numbers the ids that were inserted, beginning with `number`. Returns the number after the last.
  std::uint32_t enumerate(std::uint32_t number) {
    for (std::size_t i = 0; i < used_blocks_; ++i) {
      Block& block = blocks_[i];
      block.before = number;
      for (int k = 0; k < kWords; ++k) {
        block.in_block[k] = static_cast<std::uint16_t>(number - block.before);
        number += count_bits(block.words[k]);
      }
    }
    return number;
  }
  bool contains(std::uint64_t id) const {
    const std::uint64_t place = id - first_;
    const std::uint64_t in_block = place % kBlockIds;
    return (blocks_[place / kBlockIds].words[in_block / 64] >> in_block % 64 & 1) != 0;
  }
  /// The number of an id that is contained, after enumerate.
  std::uint32_t number(std::uint64_t id) const {
    const std::uint64_t place = id - first_;
    const std::uint64_t in_block = place % kBlockIds;
    const Block& block = blocks_[place / kBlockIds];
    const std::uint64_t below = (std::uint64_t{1} << in_block % 64) - 1;
    return block.before + block.in_block[in_block / 64] + count_bits(block.words[in_block / 64] & below);
  }
  /// Calls visit(id) in ascending order.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = 0; i < used_blocks_; ++i) {
      for (int k = 0; k < kWords; ++k) {
        for (std::uint64_t word = blocks_[i].words[k]; word != 0; word &= word - 1) {
          visit(first_ + i * kBlockIds + 64 * k + static_cast<unsigned>(__builtin_ctzll(word)));
        }
      }
    }
  }

 private:
  static constexpr int kWords = 6;
  struct alignas(64) Block {
    std::uint64_t words[kWords];
    std::uint32_t before;            // the number of the block's first id
    std::uint16_t in_block[kWords];  // for each word: ids of the block before it
  };
  static_assert(sizeof(Block) == 64);

  /// Not the built-in function, which is slow on processors that may lack the instruction.
  static std::uint32_t count_bits(std::uint64_t word) {
    word -= word >> 1 & 0x5555555555555555u;
    word = (word & 0x3333333333333333u) + (word >> 2 & 0x3333333333333333u);
    word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return static_cast<std::uint32_t>(word * 0x0101010101010101u >> 56);
  }

  Buffer<Block> blocks_;
  std::size_t used_blocks_ = 0;
  std::uint64_t first_ = 0;
};

}  // namespace flaunay::prove
