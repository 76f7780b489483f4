// Cut trees (points/cut_tree.h) that are made from samples: which points are drawn, and where a node is cut.
#ifndef FLAUNAY_SAMPLED_CUTS_H
#define FLAUNAY_SAMPLED_CUTS_H

#include "arithmetic/coordinates.h"
#include "arithmetic/language.h"
#include "points/records.h"

BEGIN_SHARED

// Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
static inline uint64 mixed(uint64 x) {
  x += 0x9e3779b97f4a7c15UL;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9UL;
  x = (x ^ x >> 27) * 0x94d049bb133111ebUL;
  return x ^ x >> 31;
}

// The point that is a tree's sample k: one of as many equal parts as there are samples.
static inline int drawn_point(sampled_tree own, uint64 k) {
  const uint64 begin = k * own.points / own.samples, end = (k + 1) * own.points / own.samples;
  return own.first_point + (int)(begin + mixed(k) % max((uint64)1, end - begin));
}

// A cut, at a sample.
typedef struct {
  int axis, sample;
  coordinate2 pivot;
} sample_cut;

// The cut of the node whose samples begin at `begin` in both orders.
static inline sample_cut cut_of(int begin, int size, GLOBAL const coordinate2* samples, GLOBAL const int* by_x,
                                GLOBAL const int* by_y) {
  const int low = begin + size / 4, high = begin + size - 1 - size / 4;
  const coordinate width = rounded_difference(samples[by_x[high]].x, samples[by_x[low]].x);
  const coordinate height = rounded_difference(samples[by_y[high]].y, samples[by_y[low]].y);
  sample_cut cut;
  cut.axis = height > width;
  // In one expression, GCC 12 with its sanitizers would read another element.
  GLOBAL const int* const along = cut.axis ? by_y : by_x;
  cut.sample = along[begin + size / 2];
  cut.pivot = samples[cut.sample];
  return cut;
}

static inline cut_node node_of(int axis, coordinate2 pivot) {
  const uint64 x = orderable(pivot.x), y = orderable(pivot.y);
  cut_node node;
  node.major = axis ? y : x;
  node.minor = axis ? ~x : y;
  node.turn = axis ? ~(uint64)0 : (uint64)0;
  return node;
}

// The samples of a node at a level; of a level below its leaves, fewer.
static inline int node_samples(sampled_tree own, int level) { return own.samples >> level; }

END_SHARED

#endif
