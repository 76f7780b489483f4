// Refinement within a block, by the sequential algorithm: bad triangles in the order of classes, each mended by a point
// whose cavity is dug out and replaced by a star. A block changes only rows whose corners are all in its leaf of the
// plane; it reads the corners of rows that have corners in several leaves, which nobody changes. Tasks that
// need other rows are put aside for the next phase. Nothing depends on numbers of rows or vertices.
#ifndef FLAUNAY_REFINEMENT_BLOCKS_H
#define FLAUNAY_REFINEMENT_BLOCKS_H

#include "arithmetic/language.h"
#include "constrained/meanwhile.h"
#include "refinement/claimed_cavities.h"
#include "refinement/leaves.h"
#include "refinement/limits.h"
#include "refinement/quality_of_rows.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// The first digging of a cavity ends at this many rows: with the point beyond a constraint, it may be no tree.
#define MOST_UNPROVEN 64
// The in-circle test of `dig`: its terms are as in predicates/planar.h, and their magnitude is at most the sum
// of the products of two squared distances each (Cauchy and Schwarz); that sum takes seven roundings.
#define DIG_BOUND (10.5 * DOUBLE_ROUNDOFF)
#define NO_ROW INT_MAX

// The data of a work-item.
typedef struct {
  seen_mesh mesh;
  refinement_rules rules;
  refinement_phase phase;
  GLOBAL mesh_row* rows;
  GLOBAL double2* points;
  GLOBAL edge_place* places;
  GLOBAL const int* ends;
  GLOBAL const int* wedges;
  GLOBAL const double* areas;
  GLOBAL const mesh_row* given;
  GLOBAL uchar* states;
  GLOBAL int2* births;
  GLOBAL const block_cut* cuts;
  GLOBAL const double* reaches;
  GLOBAL volatile int* counters;
  // Its own: the first and the last place of each class, plus 1; tasks; the sides that are still to be dug; the rows of
  // a cavity and its sides; the tasks with which the block begins.
  GLOBAL int* heads;
  GLOBAL int* tails;
  GLOBAL block_task* tasks;
  GLOBAL dug_side* stack;
  GLOBAL int* cavity;
  GLOBAL star_side* sides;
  GLOBAL first_task* firsts;
  block_state state;
  int depth, cavity_size, side_count, hits, is_beyond;
} block_work;

// ---------------------------------------------------------------------------------------------------------------------
// Leaves

// The number by which a block marks vertices as its own.
static inline int birth_of(const block_work* work) { return work->phase.first_block + work->state.block; }

// Vertices that a block makes are its own, whatever rounding does. It meets none that others make in the same phase.
static inline int is_own_at(const block_work* work, int v, double2 p) {
  const block_state* const state = &work->state;
  return work->phase.is_whole ||
         ((p.x >= state->low[0]) & (p.x < state->high[0]) & (p.y >= state->low[1]) & (p.y < state->high[1])) ||
         work->births[v].x == birth_of(work);
}
static inline int is_own(const block_work* work, int v) { return is_own_at(work, v, work->points[v]); }
// The rectangle that is the leaf with a place.
static inline void find_leaf(block_work* work, double2 p) {
  GLOBAL const block_cut* at = work->cuts;
  for (int axis = 0; axis < 2; ++axis) {
    work->state.low[axis] = -INFINITY;
    work->state.high[axis] = INFINITY;
  }
  while (at->axis >= 0) {
    const int is_above = !((at->axis ? p.y : p.x) < at->at);
    if (is_above) work->state.low[at->axis] = at->at;
    if (!is_above) work->state.high[at->axis] = at->at;
    at = &work->cuts[at->child + is_above];
  }
}
static inline int is_own_row(const block_work* work, int row) {
  GLOBAL const int* const corners = work->rows[row].corner;
  return is_own(work, corners[0]) && is_own(work, corners[1]) && is_own(work, corners[2]);
}
// Whether both rows beside a constraint are of the block.
static inline int is_own_constraint(const block_work* work, int corner) {
  const int beyond = neighbor_at(&work->mesh, corner);
  return is_own_row(work, row_of(corner)) &&
         (beyond < 0 || is_own(work, vertex_at(&work->mesh, corner_facing(&work->mesh, beyond, row_of(corner)))));
}

// ---------------------------------------------------------------------------------------------------------------------
// Bad triangles

static inline double shorter(double l, double m, double n) {
  const double first = l < m ? l : m;
  return n < first ? n : first;
}

// Eight classes per factor of two.
static inline int tier_of(double square, refinement_rules rules) {
  return min(TASK_CLASSES / 2 - 2, max(0, (int)(as_ulong(square) >> 49) - rules.least_class));
}
#define TIER_LATER -1
#define TIER_GOOD -2
// Less a reason: its angle is excused.
#define TIER_EXCUSED -2

static inline double2 middle_of_shortest(const double2* p) {
  const int k = opposite_to_shortest(p);
  const double2 a = p[(k + 1) % 3], b = p[(k + 2) % 3];
  return VECTOR(double2, (a.x + b.x) / 2.0, (a.y + b.y) / 2.0);
}
static inline double squared_circumradius(const double2* p) {
  const double2 u = p[1] - p[0], v = p[2] - p[0];
  const double cross = u.x * v.y - u.y * v.x;
  return squared_distance(p[0], p[1]) * squared_distance(p[0], p[2]) * squared_distance(p[1], p[2]) /
         (4.0 * cross * cross);
}

static inline double2 centroid_of(const seen_mesh* mesh, int row) {
  const ordered_triangle triangle = ordered(mesh, row);
  const double2* const p = triangle.point;
  return VECTOR(double2, (p[0].x + p[1].x + p[2].x) / 3.0, (p[0].y + p[1].y + p[2].y) / 3.0);
}

// Whether p is beyond the side opposite to a corner. On the line, a point counts as a little to the right, and less
// above, so that it is in one triangle only.
static inline int is_beyond(const seen_mesh* mesh, int corner, double2 p) {
  const double2 from = point_at(mesh, next_halfedge(corner)), to = point_at(mesh, previous_halfedge(corner));
  const int side = orient_sign(from, to, p, ORIENT_BOUND);
  return side < 0 || (side == 0 && (to.y > from.y || (to.y == from.y && to.x < from.x)));
}

// The triangle with p in it, by a walk that begins at a row and crosses no constraint. Which sides it tries first does
// not depend on numbers.
static inline int walk_within(const seen_mesh* mesh, int row, double2 p) {
  for (;;) {
    const ordered_triangle triangle = ordered(mesh, row);
    int next = -1;
    for (int k = 0; k < 3 && next < 0; ++k) {
      const int corner = triangle.corner[k];
      if (edge_at(mesh, corner) < 0 && is_beyond(mesh, corner, p)) next = neighbor_at(mesh, corner);
    }
    if (next < 0) return row;
    row = next;
  }
}

// The parent of a row that was made in the place of another one of the same region: the triangle of the given
// mesh that contains its centroid. given: the rows of that mesh.
static inline int parent_of(const seen_mesh* mesh, GLOBAL const mesh_row* given, int row, refinement_rules rules) {
  const seen_mesh before = {given, mesh->points};
  const double2 p = centroid_of(mesh, row);
  return walk_within(&before, mesh->rows[row].parent,
                     VECTOR(double2, rounded_to(p.x, rules.coarse), rounded_to(p.y, rules.coarse)));
}

// The largest area of a triangle, or 0. For rows that a block makes, areas by rows are not known yet.
static inline double area_of_row(const seen_mesh* mesh, int row, refinement_rules rules, GLOBAL const double* areas,
                                 int is_new) {
  if (rules.area_kind == AREAS_BY_ROW && is_new) return rules.area;
  return area_wanted(mesh, row, rules, areas);
}

// The class in which a triangle that is too large acts, the largest ones first, or TIER_LATER, or TIER_GOOD.
static inline int tier_of_large(const seen_mesh* mesh, int row, refinement_rules rules, double level,
                                GLOBAL const double* areas, int is_new) {
  const double area = area_of_row(mesh, row, rules, areas, is_new);
  double2 p[3];
  for (int k = 0; k < 3; ++k) p[k] = point_at(mesh, 3 * row + k);
  if (!(area > 0.0 && area < INFINITY && is_area_above(p[0], p[1], p[2], area))) return TIER_GOOD;
  if (level > 1.0 && !(area * level < INFINITY && is_area_above(p[0], p[1], p[2], area * level))) return TIER_LATER;
  const ordered_triangle triangle = ordered(mesh, row);
  const double2 u = triangle.point[1] - triangle.point[0], v = triangle.point[2] - triangle.point[0];
  return TASK_CLASSES / 2 - 1 - tier_of(fabs(u.x * v.y - u.y * v.x), rules);
}

// The class of a triangle with a small angle: after large triangles, by ascending `shortest`, the squared side.
static inline int tier_of_small(const seen_mesh* mesh, int row, refinement_rules rules, double shortest,
                                GLOBAL const edge_place* places, GLOBAL const int* ends, GLOBAL const int* wedges) {
  GLOBAL const mesh_row* const at = &mesh->rows[row];
  const int constraints = (at->edge[0] >= 0) + (at->edge[1] >= 0) + (at->edge[2] >= 0);
  // Only vertices on edges at apexes have some.
  int at_apexes = 0;
  for (int k = 0; k < 3 && rules.has_apexes; ++k) at_apexes += places[at->corner[k]].apex >= 0;
  if ((at_apexes > 1) | (constraints > 1)) {
    const ordered_triangle triangle = ordered(mesh, row);
    const int excuse = excuse_of(mesh, &triangle, places, ends, wedges, rules.vertices);
    if (excuse != EXCUSED_NOT) return TIER_EXCUSED - excuse;
  }
  return TASK_CLASSES / 2 + tier_of(shortest, rules);
}

// The class of any triangle.
static inline int tier_of_row(const seen_mesh* mesh, int row, refinement_rules rules, double level,
                              GLOBAL const double* areas, int is_new, GLOBAL const edge_place* places,
                              GLOBAL const int* ends, GLOBAL const int* wedges) {
  if (rules.area > 0.0 || rules.area_kind != AREAS_NONE) {
    const int large = tier_of_large(mesh, row, rules, level, areas, is_new);
    if (large != TIER_GOOD) return large;
  }
  GLOBAL const int* const corners = mesh->rows[row].corner;
  const double2 a = mesh->points[corners[0]], b = mesh->points[corners[1]], c = mesh->points[corners[2]];
  if (!is_angle_below(a, b, c, rules.squared_sine)) return TIER_GOOD;
  const double shortest = shorter(squared_distance(a, b), squared_distance(b, c), squared_distance(c, a));
  return tier_of_small(mesh, row, rules, shortest, places, ends, wedges);
}

// Whether an apex of the triangles beside a constraint, opposite to corner k of a row, encroaches it. The one beyond
// may be as it was when rounding did not allow to split the constraint.
static inline int is_encroached_from_a_side(const seen_mesh* mesh, int row, int k, refinement_rules rules) {
  GLOBAL const mesh_row* const at = &mesh->rows[row];
  const double2 from = mesh->points[at->corner[next_corner(k)]], to = mesh->points[at->corner[corner_before(k)]];
  if (encroaches(from, to, mesh->points[at->corner[k]], rules.squared_cosine)) return 1;
  if (at->neighbor[k] < 0) return 0;
  GLOBAL const mesh_row* const beyond = &mesh->rows[at->neighbor[k]];
  return encroaches(from, to, mesh->points[beyond->corner[number_facing(beyond, row)]], rules.squared_cosine);
}

// A bit per corner whose opposite constraint is to be split.
static inline int splits_of_row(const seen_mesh* mesh, int row, refinement_rules rules) {
  int splits = 0, is_far;
  for (int k = 0; k < 3; ++k) {
    if (mesh->rows[row].edge[k] >= 0 && is_encroached_from_a_side(mesh, row, k, rules) &&
        why_not_split_here(mesh, 3 * row + k, rules, &is_far) == EXCUSED_NOT)
      splits |= ROW_SPLITS << k;
  }
  return splits;
}

// ---------------------------------------------------------------------------------------------------------------------
// Tasks

static inline void push_task(block_work* work, int tier, int row, int task) {
  block_state* const state = &work->state;
  int at;
  if (state->free_task > 0) {
    at = state->free_task;
    state->free_task = work->tasks[at - 1].next;
    --state->free_count;
  } else {
    at = ++state->used_tasks;
  }
  const block_task made = {row, work->rows[row].changed, task, 0};
  work->tasks[at - 1] = made;
  if (work->heads[tier] == 0) {
    work->heads[tier] = at;
    state->classes[tier >> 6] |= (uint64)1 << (63 - (tier & 63));
    state->groups |= 0x80000000u >> (tier >> 6);
  } else {
    work->tasks[work->tails[tier] - 1].next = at;
  }
  work->tails[tier] = at;
}
// Notes that a class has no tasks.
static inline void empty_tier(block_state* state, int tier) {
  state->classes[tier >> 6] &= ~((uint64)1 << (63 - (tier & 63)));
  if (state->classes[tier >> 6] == 0) state->groups &= ~(0x80000000u >> (tier >> 6));
}
static inline int first_tier(const block_work* work) {
  if (work->state.groups == 0) return -1;
  const int group = clz((int)work->state.groups);
  return group << 6 | (int)clz(work->state.classes[group]);
}
static inline void drop_task(block_work* work, int tier) {
  block_state* const state = &work->state;
  const int at = work->heads[tier], next = work->tasks[at - 1].next;
  work->tasks[at - 1].next = state->free_task;
  state->free_task = at;
  ++state->free_count;
  work->heads[tier] = next;
  if (next == 0) empty_tier(state, tier);
}
static inline int room_for_tasks(const block_work* work) {
  return work->phase.room - work->state.used_tasks + work->state.free_count;
}

static inline int state_of_tier(int tier) { return tier >= TIER_LATER ? ROW_BAD : TIER_EXCUSED - tier; }

// The class of a bad triangle in a scaffold: it acts if its circumradius exceeds its leaf's reach.
static inline int tier_in_scaffold(GLOBAL const block_cut* cuts, GLOBAL const double* reaches, const seen_mesh* mesh,
                                   int row, refinement_rules rules) {
  const ordered_triangle triangle = ordered(mesh, row);
  const double radius = squared_circumradius(triangle.point);
  return radius > reaches[leaf_at(cuts, middle_of_shortest(triangle.point))]
             ? TASK_CLASSES / 2 - 1 - tier_of(radius, rules)
             : TIER_LATER;
}

// Tests a triangle that was made. is_small: whether it has a small angle; shortest: the square of its shortest side.
static inline void test_made(block_work* work, int row, int is_small, double shortest) {
  GLOBAL const mesh_row* const at = &work->rows[row];
  int state = work->rules.area_kind == AREAS_BY_ROW ? ROW_NEW : 0;
  if (work->rules.has_given) work->rows[row].parent = parent_of(&work->mesh, work->given, row, work->rules);
  if (!work->phase.segments_only) {
    int tier = TIER_GOOD;
    if (work->rules.area > 0.0 || work->rules.area_kind != AREAS_NONE)
      tier = tier_of_large(&work->mesh, row, work->rules, work->phase.level, work->areas, 1);
    if (tier == TIER_GOOD && is_small)
      tier = tier_of_small(&work->mesh, row, work->rules, shortest, work->places, work->ends, work->wedges);
    state |= state_of_tier(tier);
    if (tier >= TIER_LATER && work->phase.is_scaffold)
      tier = tier_in_scaffold(work->cuts, work->reaches, &work->mesh, row, work->rules);
    if (tier >= 0) push_task(work, tier, row, TASK_MEND);
  }
  if ((at->edge[0] & at->edge[1] & at->edge[2]) >= 0) {
    const int splits = splits_of_row(&work->mesh, row, work->rules);
    for (int k = 0; k < 3; ++k) {
      if (splits >> k & ROW_SPLITS) push_task(work, 0, row, k);
    }
    state |= splits;
  }
  work->states[row] = (uchar)state;
}

// ---------------------------------------------------------------------------------------------------------------------
// Cavities

INTEGER_CONSTANT(DUG, 0);
INTEGER_CONSTANT(DUG_OTHERS, 1);  // it met a row that is not of the block
INTEGER_CONSTANT(DUG_MOST, 2);

OUT_OF_LINE static inline int is_in_circle_of(const seen_mesh* mesh, int row, double2 p) {
  return is_in_circle(mesh, row, p);
}

// Member by member, as `dig` reads it soon after.
static inline void put_side(GLOBAL dug_side* side, double bx, double by, double bl, double cx, double cy, double cl,
                            double bc, int edge, int from) {
  side->bx = bx;
  side->by = by;
  side->bl = bl;
  side->cx = cx;
  side->cy = cy;
  side->cl = cl;
  side->bc = bc;
  side->edge = edge;
  side->from = from;
}

// Goes on with the cavity of p over the sides on the stack, depth first, so that sides come out
// counter-clockwise. If p is on no constraint, sides that it encroaches are counted and have their corner in
// the place of a row; is_beyond: whether p is not strictly before one of them.
static inline int dig(block_work* work, double2 p, int is_free, int most) {
  const seen_mesh mesh = work->mesh;
  GLOBAL const mesh_row* const rows = mesh.rows;
  GLOBAL const double2* const points = mesh.points;
  GLOBAL dug_side* const stack = work->stack;
  GLOBAL star_side* const sides = work->sides;
  GLOBAL int* const cavity = work->cavity;
  int depth = work->depth, count = work->side_count, size = work->cavity_size, outcome = DUG;
  while (depth > 0 && outcome == DUG) {
    // One by one: they were written so just before.
    GLOBAL const dug_side* const side = &stack[--depth];
    double bx = side->bx, by = side->by, bl = side->bl, cx = side->cx, cy = side->cy, cl = side->cl, bc = side->bc;
    int row = side->edge >> 2, k = side->edge & 3, from = side->from;
    for (;;) {
      GLOBAL const mesh_row* const at = &rows[row];
      const int beyond = at->neighbor[k], edge = at->edge[k];
      int facing = 0, hit = -1;
      if (edge < 0) {
        GLOBAL const mesh_row* const outside = &rows[beyond];
        facing = number_facing(outside, row);
        const int d = outside->corner[facing];
        const double dx = points[d].x - p.x, dy = points[d].y - p.y, dl = dx * dx + dy * dy;
        const double bd = bx * dy - dx * by, dc = dx * cy - cx * dy;
        const double det = (bl * dc - dl * bc) + cl * bd;
        const double error = DIG_BOUND * (dl * bl + cl * (dl + bl));
        int is_inside = det > error;
        if (fabs(det) <= error) is_inside = is_in_circle_of(&mesh, beyond, p);
        if (is_inside) {
          if (size >= most || !is_own_at(work, d, points[d])) {
            outcome = size >= most ? DUG_MOST : DUG_OTHERS;
            break;
          }
          cavity[size++] = beyond;
          put_side(&stack[depth++], dx, dy, dl, cx, cy, cl, dc, beyond << 2 | corner_before_any(facing), d);
          // The other side comes next: it need not be put there.
          cx = dx;
          cy = dy;
          cl = dl;
          bc = bd;
          row = beyond;
          k = corner_after_any(facing);
          continue;
        }
      } else {
        if (beyond >= 0) facing = number_facing(&rows[beyond], row);
        if (is_free) {
          const double2 b = points[at->corner[next_corner(k)]], c = points[at->corner[corner_before(k)]];
          work->is_beyond |= orient_sign(b, c, p, ORIENT_BOUND) <= 0;
          if (encroaches(b, c, p, work->rules.squared_cosine)) {
            hit = 3 * row + k;
            ++work->hits;
          }
        }
      }
      GLOBAL star_side* const found = &sides[count++];
      found->from = from;
      found->outside = beyond;
      found->facing = facing;
      found->edge = edge;
      found->parent = at->parent;
      found->row = hit;
      break;
    }
  }
  work->depth = depth;
  work->side_count = count;
  work->cavity_size = size;
  return outcome;
}

static inline void start_cavity(block_work* work) {
  work->depth = work->cavity_size = work->side_count = work->hits = work->is_beyond = 0;
}

// Adds the `count` sides of a row that follow the side opposite to corner k; that one comes last if count is
// three. Returns whether p is in the row's circle.
static inline int dig_from(block_work* work, int row, int k, int count, double2 p) {
  GLOBAL const mesh_row* const at = &work->rows[row];
  double x[3], y[3], l[3], cross[3];
  int number[3];
  for (int i = 0; i < 3; ++i) {
    number[i] = k;
    const double2 q = work->points[at->corner[k]];
    x[i] = q.x - p.x;
    y[i] = q.y - p.y;
    l[i] = x[i] * x[i] + y[i] * y[i];
    k = next_corner(k);
  }
  for (int i = 0; i < 3; ++i) {
    const int b = next_corner(i), c = corner_before(i);
    cross[i] = x[b] * y[c] - x[c] * y[b];
  }
  work->cavity[work->cavity_size++] = row;
  for (int i = 2; i >= 3 - count; --i) {
    const int b = next_corner(i), c = corner_before(i);
    put_side(&work->stack[work->depth++], x[b], y[b], l[b], x[c], y[c], l[c], cross[i], row << 2 | number[i],
             at->corner[number[b]]);
  }
  const double det = (l[0] * cross[0] + l[1] * cross[1]) + l[2] * cross[2];
  const double magnitude = l[0] * l[1] + l[2] * (l[0] + l[1]);
  return fabs(det) > DIG_BOUND * magnitude ? det > 0.0 : is_in_circle_of(&work->mesh, row, p);
}

// Whether a vertex around the cavity, or another one, is nearer to p than the smallest edge, or in the same place.
static inline int is_too_near(const block_work* work, double2 p, int other) {
  for (int i = 0; i <= work->side_count; ++i) {
    const double distance = squared_distance(p, work->points[i < work->side_count ? work->sides[i].from : other]);
    if (distance < work->rules.min_edge || distance == 0.0) return 1;
  }
  return 0;
}

// A constraint that rounding did not allow to split is tried again when a triangle there is another one.
static inline int thawed(int edge) { return edge < 0 ? edge : edge & ~EDGE_FROZEN; }

// Replaces the cavity by triangles around a point. edge: the edge that it is on, between vertices a and b, or
// NO_EDGE_THERE. If that is on the border, the triangles do not go all the way round.
static inline void write_star(block_work* work, double2 p, edge_place place, int edge, int a, int b, int is_open) {
  const int v = work->state.vertex++, count = work->side_count, size = work->cavity_size;
  work->points[v] = p;
  work->places[v] = place;
  work->births[v] = VECTOR(int2, birth_of(work), work->state.inserted);
  ++work->state.inserted;
  for (int i = size; i < count; ++i) work->cavity[i] = work->state.row++;
  // The side after the last one.
  work->sides[count].from = is_open ? a : work->sides[0].from;
  work->cavity[count] = is_open ? -1 : work->cavity[0];
  int before = is_open ? -1 : work->cavity[count - 1];
  for (int i = 0; i < count; ++i) {
    star_side side = work->sides[i];
    const int row = work->cavity[i], to = work->sides[i + 1].from, after = work->cavity[i + 1];
    GLOBAL mesh_row* const written = &work->rows[row];
    side.edge = thawed(side.edge);
    write_star_row(written, v, side, to, after, before, edge, a, b);
    written->parent = side.parent;
    ++written->changed;
    if (side.outside >= 0) {
      write_shared((GLOBAL volatile int*)&work->rows[side.outside].neighbor[side.facing], row);
      if (side.edge >= 0) work->rows[side.outside].edge[side.facing] = side.edge;
    }
    before = row;
  }
  // Triangles that follow each other share a side: its other end, and that relative to the point.
  double2 to = work->points[work->sides[0].from], w = to - p;
  double ww = squared_length(w);
  for (int i = 0; i < count; ++i) {
    const double2 from = to, u = w;
    const double uu = ww;
    to = work->points[work->sides[i + 1].from];
    w = to - p;
    ww = squared_length(w);
    const double opposite = squared_distance(from, to);
    int is_small = sine_of_sides_filtered(u.x * w.y - w.x * u.y, uu, opposite, ww, work->rules.squared_sine);
    if (is_small == UNDECIDED) is_small = is_angle_below_exact(p, from, to, work->rules.squared_sine);
    test_made(work, work->cavity[i], is_small, shorter(uu, opposite, ww));
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Constraints

static inline void freeze(block_work* work, int corner) {
  const int beyond = neighbor_at(&work->mesh, corner);
  work->rows[row_of(corner)].edge[corner % 3] |= EDGE_FROZEN;
  if (beyond >= 0) work->rows[beyond].edge[number_facing(&work->rows[beyond], row_of(corner))] |= EDGE_FROZEN;
}

// Splits the constraint opposite to a corner.
OUT_OF_LINE static inline int split(block_work* work, int corner) {
  const seen_mesh* const mesh = &work->mesh;
  if (!is_own_constraint(work, corner)) return TASK_ASIDE;
  int is_far;
  const int reason = why_not_split_here(mesh, corner, work->rules, &is_far);
  if (reason != EXCUSED_NOT) return reason;
  const split_place place = place_of_constraint(mesh, corner, work->places, work->ends, work->rules);
  const double2 p = place.point;
  if (!can_split_at(mesh, corner, p)) {
    freeze(work, corner);
    return EXCUSED_FROZEN;
  }
  const int row = row_of(corner), beyond = neighbor_at(mesh, corner), from = vertex_at(mesh, next_halfedge(corner)),
            to = vertex_at(mesh, previous_halfedge(corner));
  start_cavity(work);
  for (int side = 0; side < (beyond < 0 ? 1 : 2); ++side) {
    const int inside = side ? beyond : row;
    dig_from(work, inside, side ? number_facing(&work->rows[beyond], row) : corner - 3 * row, 2, p);
    const int outcome = dig(work, p, 0, work->phase.room);
    if (outcome != DUG) return outcome == DUG_OTHERS ? TASK_ASIDE : TASK_FULL;
  }
  if (!is_far && is_too_near(work, p, from)) return EXCUSED_MIN_EDGE;
  if (work->side_count != work->cavity_size + (beyond < 0 ? 1 : 2)) return EXCUSED_FROZEN;
  if (room_for_tasks(work) < 4 * work->side_count) return TASK_FULL;
  write_star(work, p, place.at, place.at.edge, from, to, beyond < 0);
  return TASK_DONE;
}

// ---------------------------------------------------------------------------------------------------------------------
// Bad triangles

// The off-centre of a triangle (Uengoer, 2009): on the bisector of the shortest side, as far from it as the
// circumcentre, but no farther than where an edge to it would make the smallest angle that is wanted. Relative to the
// first end of that side. apex: the corner opposite.
static inline double2 centre_of(double2 from, double2 to, double2 apex, int is_large, refinement_rules rules) {
  const double2 u = to - from, v = apex - from;
  const double uu = squared_length(u), vv = squared_length(v), scale = 0.5 / (u.x * v.y - u.y * v.x);
  double2 centre = VECTOR(double2, (v.y * uu - u.y * vv) * scale, (u.x * vv - v.x * uu) * scale);
  if (!is_large && rules.off_centre > 0.0) {
    const double2 off = VECTOR(double2, 0.5 * u.x - rules.off_centre * u.y, 0.5 * u.y + rules.off_centre * u.x);
    if (squared_length(off) < squared_length(centre)) centre = off;
  }
  return centre;
}

// Walks from a corner's triangle to p, over one side after the other that p is beyond. Returns the first corner of its
// triangle; or of a constraint in the way, the corner opposite, complemented; or NO_ROW where it would leave the block.
// In Delaunay triangulations it ends (Edelsbrunner, 1990).
static inline int walk_to(const block_work* work, int corner, double2 p) {
  const seen_mesh* const mesh = &work->mesh;
  int row = row_of(corner), k = corner - 3 * row, left = 3;
  double2 from = point_at(mesh, next_halfedge(corner));
  while (left > 0) {
    GLOBAL const mesh_row* const at = &mesh->rows[row];
    const double2 to = mesh->points[at->corner[corner_before(k)]];
    if (orient_sign(from, to, p, ORIENT_BOUND) < 0) {
      if (at->edge[k] >= 0) return ~(3 * row + k);
      const int beyond = at->neighbor[k];
      if (!is_own_row(work, beyond)) return NO_ROW;
      // The next side begins where this one does.
      k = next_corner(number_facing(&mesh->rows[beyond], row));
      row = beyond;
      left = 2;
    } else {
      k = next_corner(k);
      from = to;
      --left;
    }
  }
  return 3 * row;
}

// Notes that a constraint is to be split for a bad triangle, unless it must not be. Returns why.
static inline int want_split(block_work* work, int corner) {
  int is_far;
  if (!is_own_constraint(work, corner)) {
    work->state.retry_aside = 1;
    return EXCUSED_NOT;
  }
  const int reason = why_not_split_here(&work->mesh, corner, work->rules, &is_far);
  if (reason == EXCUSED_NOT) push_task(work, 0, row_of(corner), TASK_WANTED + corner % 3);
  return reason;
}

// Mends a bad triangle.
static inline int mend(block_work* work, int row, int is_large) {
  const refinement_rules rules = work->rules;
  const ordered_triangle triangle = ordered(&work->mesh, row);
  const int k = opposite_to_shortest(triangle.point);
  const double2 from = triangle.point[corner_after_any(k)],
                centre = centre_of(from, triangle.point[corner_before_any(k)], triangle.point[k], is_large, rules),
                p = VECTOR(double2, rounded_to(from.x + centre.x, rules.coarse),
                           rounded_to(from.y + centre.y, rules.coarse));
  // Farther points are not rounded by as much as an eighth of that, and all vertices are nearly as far away: the
  // circle around such a point leaves that of the triangle only beyond the shortest side, which is not much nearer.
  const double distance = squared_distance(p, from);
  const int is_close = distance < rules.long_edge;
  if (!(distance >= rules.min_edge) || (is_close && 64.0 * squared_distance(p - from, centre) > distance) ||
      !(fabs(p.x) < INFINITY && fabs(p.y) < INFINITY))
    return EXCUSED_MIN_EDGE;
  start_cavity(work);
  // The point of a flat triangle may be rounded out of its circle.
  if (!dig_from(work, row, triangle.corner[0] - 3 * row, 3, p)) return EXCUSED_MIN_EDGE;
  int outcome = dig(work, p, 1, min(MOST_UNPROVEN, work->phase.room));
  if (outcome == DUG_OTHERS) return TASK_ASIDE;
  if (outcome == DUG_MOST || work->is_beyond) {
    const int found = walk_to(work, triangle.corner[0], p);
    if (found == NO_ROW) return TASK_ASIDE;
    if (found < 0) {
      work->state.retry_reason = want_split(work, ~found);
      return work->state.retry_reason == EXCUSED_NOT ? TASK_SPLITS : work->state.retry_reason;
    }
    if (outcome == DUG_MOST) {
      // From here on it is a tree.
      start_cavity(work);
      dig_from(work, row_of(found), ordered(&work->mesh, row_of(found)).corner[0] - 3 * row_of(found), 3, p);
      outcome = dig(work, p, 1, work->phase.room);
      if (outcome != DUG) return outcome == DUG_OTHERS ? TASK_ASIDE : TASK_FULL;
    }
    if (work->is_beyond && work->hits == 0) return EXCUSED_FROZEN;
  }
  if (room_for_tasks(work) < 4 * work->side_count) return TASK_FULL;
  if (work->hits > 0) {
    // Constraints that may be split are, whatever others are encroached.
    int refused = EXCUSED_LIMIT, wants = 0;
    for (int i = 0; i < work->side_count; ++i) {
      if (work->sides[i].row < 0) continue;
      const int reason = want_split(work, work->sides[i].row);
      wants |= reason == EXCUSED_NOT;
      if (reason != EXCUSED_NOT) refused = min(refused, reason);
    }
    work->state.retry_reason = refused;
    return wants ? TASK_SPLITS : refused;
  }
  if (is_close && is_too_near(work, p, work->sides[0].from)) return EXCUSED_MIN_EDGE;
  if (work->side_count != work->cavity_size + 2) return EXCUSED_FROZEN;
  const edge_place nowhere = {0.0, 0.0, -1, -1};
  write_star(work, p, nowhere, NO_EDGE_THERE, -1, -1, 0);
  return TASK_DONE;
}

// ---------------------------------------------------------------------------------------------------------------------
// Blocks

static inline int comes_first(const block_work* work, first_task a, first_task b) {
  if (a.key != b.key) return a.key < b.key;
  const ordered_triangle s = ordered(&work->mesh, a.row), t = ordered(&work->mesh, b.row);
  const int order = order_by_corners(&s, &t);
  return order != 0 ? order > 0 : a.turn < b.turn;
}

// Sorts the first tasks of the block, by a heap whose root is the last task.
static inline void sort_first(block_work* work, int count) {
  GLOBAL first_task* const firsts = work->firsts;
  int root = count / 2;
  for (int end = count; end > 1;) {
    first_task moved;
    if (root > 0) {
      moved = firsts[--root];
    } else {
      moved = firsts[--end];
      firsts[end] = firsts[0];
    }
    int at = root;
    for (int child = 2 * at + 1; child < end; child = 2 * at + 1) {
      if (child + 1 < end) child += comes_first(work, firsts[child], firsts[child + 1]);
      if (!comes_first(work, moved, firsts[child])) break;
      firsts[at] = firsts[child];
      at = child;
    }
    firsts[at] = moved;
  }
}

// list: the rows that the block may begin with.
static inline void start_block(block_work* work, GLOBAL const int* list, int first, int end) {
  const refinement_rules rules = work->rules;
  int count = 0;
  if (first < end) {
    // Nobody changes a row with this place before its block does.
    const ordered_triangle triangle = ordered(&work->mesh, list[first]);
    find_leaf(work, middle_of_shortest(triangle.point));
  }
  for (int i = first; i < end; ++i) {
    const int row = list[i], state = work->states[row];
#if FETCH_AHEAD
    fetch_row(&work->mesh, list[min(end - 1, i + ROWS_AHEAD)]);
    fetch_corners(&work->mesh, list[min(end - 1, i + ROWS_NEXT)]);
    fetch_neighbors(&work->mesh, list[min(end - 1, i + ROWS_NEXT)]);
#endif
    if (!is_own_row(work, row)) continue;
    const ordered_triangle triangle = ordered(&work->mesh, row);
    first_task made = {key_of(&triangle), row, TASK_MEND, TIER_LATER, 0};
    if ((state & ROW_BAD) && !work->phase.segments_only) {
      if (work->phase.is_scaffold) {
        made.tier = tier_in_scaffold(work->cuts, work->reaches, &work->mesh, row, rules);
      } else {
        made.tier = TIER_GOOD;
        if (rules.area > 0.0 || rules.area_kind != AREAS_NONE)
          made.tier = tier_of_large(&work->mesh, row, rules, work->phase.level, work->areas, 0);
        if (made.tier == TIER_GOOD) made.tier = TASK_CLASSES / 2 + tier_of(square_in_key(made.key), rules);
      }
      if (made.tier >= 0) work->firsts[count++] = made;
    }
    for (int k = 0; k < 3; ++k) {
      made.task = triangle.corner[k] - 3 * row;
      made.tier = 0;
      made.turn = k + 1;
      if (state >> made.task & ROW_SPLITS) work->firsts[count++] = made;
    }
  }
  sort_first(work, count);
  for (int i = 0; i < count; ++i) push_task(work, work->firsts[i].tier, work->firsts[i].row, work->firsts[i].task);
}

// Takes chunks if fewer rows or vertices are left than a point needs; returns whether there are some.
static inline int reserve(block_work* work) {
  block_state* const state = &work->state;
  if (state->row_end - state->row < 2) {
    const int row = (int)atomic_add((GLOBAL volatile uint*)&work->counters[COUNT_ROWS], (uint)ROWS_PER_CHUNK);
    if (row > work->phase.row_room - ROWS_PER_CHUNK) return 0;
    state->row = row;
    state->row_end = row + ROWS_PER_CHUNK;
    for (int i = row; i < state->row_end; ++i) {
      work->rows[i].corner[0] = NO_TRIANGLE;
      work->rows[i].changed = 0;
      work->states[i] = 0;
    }
  }
  if (state->vertex == state->vertex_end) {
    const int v = (int)atomic_add((GLOBAL volatile uint*)&work->counters[COUNT_VERTICES], (uint)VERTICES_PER_CHUNK);
    if (v > work->phase.vertex_room - VERTICES_PER_CHUNK) return 0;
    state->vertex = v;
    state->vertex_end = v + VERTICES_PER_CHUNK;
    for (int i = v; i < state->vertex_end; ++i) work->births[i] = VECTOR(int2, -1, 0);
  }
  return 1;
}

// All constraints were split that a bad triangle wants, or could not be: it is tried again if some were; otherwise it
// is put aside if some are for the next phase, or refused.
static inline void end_retry(block_work* work) {
  block_state* const state = &work->state;
  const int row = state->retry;
  state->retry = -1;
  if (work->rows[row].changed != state->retry_changed) return;
  if (state->inserted > state->retry_inserted) {
    work->states[row] |= ROW_BAD;
    push_task(work, state->retry_class, row, TASK_MEND);
  } else if (state->retry_aside) {
    work->states[row] |= ROW_BAD;
  } else {
    work->states[row] = (uchar)((work->states[row] & ~ROW_REFUSED) | state->retry_reason);
  }
}

// Goes on with the block. Returns 0 at its end, otherwise what it lacks: NEEDS_ROWS and so on.
static inline int run_block(block_work* work, int* steps) {
  block_state* const state = &work->state;
  while (state->inserted < work->phase.most) {
    if (!reserve(work)) return NEEDS_ROWS;
    if (room_for_tasks(work) < SPARE_ROOM) return NEEDS_ROOM;
    if ((*steps)-- == 0) return NEEDS_STEPS;
    const int tier = first_tier(work);
    if (state->retry >= 0 && tier != 0) {
      end_retry(work);
      continue;
    }
    if (tier < 0) return 0;
    const block_task task = work->tasks[work->heads[tier] - 1];
    const int row = task.row;
    if (work->rows[row].changed == task.changed) {
      if (task.task >= 0) {
        const int k = task.task & 3;
        const int outcome = split(work, 3 * row + k);
        if (outcome == TASK_FULL) return NEEDS_ROOM;
        if (task.task >= TASK_WANTED) {
          if (outcome == TASK_ASIDE) state->retry_aside = 1;
          if (outcome != TASK_ASIDE && outcome != TASK_DONE) state->retry_reason = min(state->retry_reason, outcome);
        } else if (outcome != TASK_ASIDE && outcome != TASK_DONE) {
          work->states[row] &= (uchar) ~(ROW_SPLITS << k);
        }
      } else {
        state->retry_aside = 0;
        const int outcome = mend(work, row, tier < TASK_CLASSES / 2);
        if (outcome == TASK_FULL) return NEEDS_ROOM;
        if (outcome == TASK_SPLITS) {
          state->retry = row;
          state->retry_changed = task.changed;
          state->retry_class = tier;
          state->retry_inserted = state->inserted;
          if (state->retry_reason == EXCUSED_NOT) state->retry_reason = EXCUSED_LIMIT;
          work->states[row] &= (uchar)~ROW_BAD;
        } else if (outcome < TASK_ASIDE && outcome != TASK_DONE) {
          work->states[row] = (uchar)((work->states[row] & ~(ROW_BAD | ROW_REFUSED)) | outcome);
        }
      }
    }
    drop_task(work, tier);
  }
  return 0;
}

// Tasks that were not done are still marked in the states of rows.
static inline void end_block(block_work* work) {
  block_state* const state = &work->state;
  if (state->retry >= 0 && work->rows[state->retry].changed == state->retry_changed)
    work->states[state->retry] |= ROW_BAD;
  for (int tier = first_tier(work); tier >= 0; tier = first_tier(work)) {
    work->heads[tier] = 0;
    empty_tier(state, tier);
  }
  state->used_tasks = state->free_task = state->free_count = 0;
  state->retry = -1;
}

END_SHARED

#endif

#endif
