// Walks the hierarchy as bvh.glsl does, with the lanes of a subgroup together: a lane that has
// nothing to do takes over a part that the ray of another lane has still to visit. A pass takes as
// long as its longest rays, which visit hundreds of nodes one after the other.
// Include after the extensions for subgroups, what bvh.glsl needs, the workgroup's size, and
// bindings `ray_count` and `rays` in the pass set.
#ifndef HELIOGRAPH_LIB_BVH_TOGETHER_GLSL
#define HELIOGRAPH_LIB_BVH_TOGETHER_GLSL
#include "lib/rays/bvh.glsl"
#include "lib/rays/ray_index.glsl"

const uint lanes = gl_WorkGroupSize.x;
/// Nodes that a lane visits before it may give or take. Fewer cost more exchanges, more leave lanes
/// idle for longer.
const uint nodes_between_exchanges = 4u;

// Of the ray that a lane has begun with, whichever lanes walk it now.
shared uint ray_of[lanes];
shared uint nearest[lanes];   // bits of the distance of the closest hit, or of the ray's end
shared uint reporter[lanes];  // the lane that has found this hit; any hit: whether there is one
shared Hit hit_of[lanes];     // the closest

// What is given away.
shared uint given_owner[lanes];
shared uint given_record[lanes];
shared uint given_link[lanes];

const uint no_owner = 0xffffffffu;
const uint top_level = 0xffffffffu;  // in place of an instance's record

// What a lane works on.
uint owner;          // the lane that has begun with the ray
float t_min;         // of the ray
uint link;           // what is visited next
uint record;         // the instance's, or top_level
uvec4 placed;        // of the instance: root, instance, mask, flat_tree
Line line;           // in the space of the level
uint bottom;         // where the level's bvh_no_link lies on the stack
uint waiting_above;  // of the top level, while in an instance: links, with its bvh_no_link

void begin(uint lane) {
  owner = lane;
  const Ray ray = rays[ray_of[lane]];
  t_min = ray.t_min;
  blending = ray_blending(ray, ray_count.blending);
  line = make_line(ray.origin, ray.direction);
  record = top_level;
  waiting = 0u;
  bottom = 0u;
  push(bvh_no_link);
}

void enter(uint instance_record) {
  record = instance_record;
  placed = record_bits(record, 3u);
  line = into_mesh(record, line);
  waiting_above = waiting;
  bottom = waiting;
  push(bvh_no_link);
}

void leave() {
  const Ray ray = rays[ray_of[owner]];
  line = make_line(ray.origin, ray.direction);
  record = top_level;
  waiting = waiting_above;
  bottom = 0u;
}

/// Visits what comes next on the ray's way: a few nodes, up to a leaf. Returns whether any is left.
bool walk(inout Hit hit) {
  const vec2 range = vec2(t_min, hit.t);
  for (uint i = 0u; i < nodes_between_exchanges && is_node(link); ++i) {
    link = next_link(link, line, range);
  }
  if (is_node(link)) return true;
  if (record != top_level) {
    if (link != bvh_no_link) {
      link = test_leaf(link, line, t_min, placed, hit);
    } else {
      leave();
      link = pop();
    }
    return true;
  }
  if (link == bvh_no_link) return false;
  enter(link & bvh_leaf_first_mask);
  link = placed.x;
  return true;
}

bool has_links_waiting() { return waiting > bottom + 1u; }
bool can_give() { return has_links_waiting() || (record != top_level && waiting_above > 1u); }

/// The link that waits for the shortest time: closer to the ray's origin than others of its level,
/// it is the least likely to be behind a hit.
void give(uint place) {
  const bool of_level = has_links_waiting();
  given_owner[place] = owner;
  given_record[place] = of_level ? record : top_level;
  given_link[place] = of_level ? pop() : stack[--waiting_above];
}

void take(uint place) {
  begin(given_owner[place]);
  if (given_record[place] != top_level) enter(given_record[place]);
  link = given_link[place];
}

/// Lanes of the subgroup that are idle take over from those that can give. `first`: the subgroup's
/// first lane; the others follow it by gl_LocalInvocationIndex.
void exchange(uint first) {
  const bool idle = owner == no_owner;
  const bool gives = !idle && can_give();
  const uvec4 takers = subgroupBallot(idle);
  const uvec4 givers = subgroupBallot(gives);
  const uint count = min(subgroupBallotBitCount(takers), subgroupBallotBitCount(givers));
  if (count == 0u) return;
  const uint taker = subgroupBallotExclusiveBitCount(takers);
  const uint giver = subgroupBallotExclusiveBitCount(givers);
  if (gives && giver < count) give(first + giver);
  subgroupBarrier();
  if (idle && taker < count) take(first + taker);
  subgroupBarrier();
}

/// Of several lanes with hits of the same ray the closest one's is kept. Which of equal ones, as on
/// coincident surfaces, depends on the rays that share the subgroup.
void report(Hit hit) {
  const bool found = hit.instance != hit_none;
  if (!subgroupAny(found)) return;
  const uint distance = floatBitsToUint(hit.t);  // in the order of the distances, which are positive
  if (found) atomicMin(nearest[owner], distance);
  subgroupBarrier();
  const bool closest = found && nearest[owner] == distance;
  if (closest) reporter[owner] = gl_LocalInvocationIndex;
  subgroupBarrier();
  if (closest && reporter[owner] == gl_LocalInvocationIndex) hit_of[owner] = hit;
  subgroupBarrier();
}

/// Begins with the ray of this number, or with nothing if it is not_traced.
void begin_ray(uint index, uint root) {
  const uint lane = gl_LocalInvocationIndex;
  ray_of[lane] = index;
  reporter[lane] = 0u;
  owner = no_owner;
  if (index == not_traced) return;
  const Ray ray = rays[index];
  nearest[lane] = floatBitsToUint(ray.t_max);
  if (!ANY_HIT) hit_of[lane] = no_hit(ray);
  if (!(ray.t_min < ray.t_max)) return;
  begin(lane);
  link = root;
}

/// Traces the ray of this number, or none if it is not_traced, with the other lanes of the
/// subgroup, all of which call it. Then hit_of[] or, if ANY_HIT, reporter[] says at the lane's place
/// what was hit. Distances along rays are not negative.
void trace_together(uint index, uint root) {
  begin_ray(index, root);
  subgroupBarrier();
  const uint first = subgroupBroadcastFirst(gl_LocalInvocationIndex);
  while (subgroupAny(owner != no_owner)) {
    exchange(first);
    Hit hit = Hit(0.0, hit_none, 0u, 0.0, 0.0, 0u, 0u, 0u);
    bool goes_on = owner != no_owner && !(ANY_HIT && reporter[owner] != 0u);
    if (goes_on) {
      hit.t = uintBitsToFloat(nearest[owner]);
      goes_on = walk(hit);
    }
    if (!ANY_HIT) {
      report(hit);
    } else if (hit.instance != hit_none) {
      reporter[owner] = 1u;
      goes_on = false;
    }
    if (!goes_on) owner = no_owner;
  }
  subgroupBarrier();
}

#endif
