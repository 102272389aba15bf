/* Meniscus: Brownian dynamics of discs at a fluid interface, with the same bits everywhere. */

#ifndef MENISCUS_H
#define MENISCUS_H

/* Made by cbindgen from core/ffi/src: do not edit. */

#include <stddef.h>
#include <stdint.h>

/**
 * The capillary strength 1 of a disc, in the unit of meniscus_set.
 */
#define MENISCUS_STRENGTH_ONE 1048576

/**
 * What became of a call.
 */
typedef enum {
  /**
   * Done.
   */
  MENISCUS_STATUS_OK = 0,
  /**
   * A pointer is null.
   */
  MENISCUS_STATUS_NULL_POINTER = 1,
  /**
   * A pointer is not aligned for what it points to.
   */
  MENISCUS_STATUS_MISALIGNED = 2,
  /**
   * The memory is shorter than meniscus_size says.
   */
  MENISCUS_STATUS_MEMORY_TOO_SHORT = 3,
  /**
   * The capacity is not 1 to 4194304, or no memory is so large.
   */
  MENISCUS_STATUS_CAPACITY = 4,
  /**
   * An array has fewer elements than there are discs.
   */
  MENISCUS_STATUS_ARRAY_TOO_SHORT = 5,
  /**
   * The side is not a finite positive number.
   */
  MENISCUS_STATUS_SIDE = 16,
  /**
   * The side exceeds 65536 R0.
   */
  MENISCUS_STATUS_SIDE_TOO_LARGE = 17,
  /**
   * Half the side does not exceed the cut-off of the repulsion.
   */
  MENISCUS_STATUS_SIDE_TOO_SMALL = 18,
  /**
   * The capillary strength is not 0 to 1000 kBT.
   */
  MENISCUS_STATUS_CAPILLARY_STRENGTH = 19,
  /**
   * The capillary length is not a number of at least 0.01 R0.
   */
  MENISCUS_STATUS_CAPILLARY_LENGTH = 20,
  /**
   * The mesh is not a power of two from 16 to 4096.
   */
  MENISCUS_STATUS_GRID = 21,
  /**
   * The mesh spacing exceeds 16 R0.
   */
  MENISCUS_STATUS_GRID_TOO_COARSE = 22,
  /**
   * The mesh spacing is below 0.125 R0.
   */
  MENISCUS_STATUS_GRID_TOO_FINE = 23,
  /**
   * The ceiling of the time step is not 2^-40 to 1 R0^2/D.
   */
  MENISCUS_STATUS_MAX_STEP = 24,
  /**
   * The largest displacement by force is not 2^-40 to 0.5 R0.
   */
  MENISCUS_STATUS_MAX_DISPLACEMENT = 25,
  /**
   * The seed exceeds 2^63 - 1.
   */
  MENISCUS_STATUS_SEED = 26,
  /**
   * The mass assignment is no MeniscusAssignment.
   */
  MENISCUS_STATUS_ASSIGNMENT = 27,
  /**
   * The influence function is no MeniscusInfluence.
   */
  MENISCUS_STATUS_INFLUENCE = 28,
  /**
   * The gradient is no MeniscusGradient.
   */
  MENISCUS_STATUS_GRADIENT = 29,
  /**
   * The noise is no MeniscusNoise.
   */
  MENISCUS_STATUS_NOISE = 30,
  /**
   * The repulsion is neither 0 nor 1.
   */
  MENISCUS_STATUS_REPULSION = 31,
  /**
   * A coordinate is not in 0 <= coordinate < side.
   */
  MENISCUS_STATUS_COORDINATE = 32,
  /**
   * The method is no MeniscusMethod.
   */
  MENISCUS_STATUS_METHOD = 33,
  /**
   * The splitting is not 1e-5 to 8 per R0.
   */
  MENISCUS_STATUS_SPLITTING = 34,
  /**
   * The splitting exceeds 0.7 over the mesh spacing.
   */
  MENISCUS_STATUS_SPLITTING_TOO_LARGE = 35,
  /**
   * The cut-off of the near part is not a number of at least 1 R0.
   */
  MENISCUS_STATUS_CUTOFF = 36,
  /**
   * The cut-off of the near part is not below half the side.
   */
  MENISCUS_STATUS_CUTOFF_TOO_LARGE = 37,
  /**
   * The influence function does not belong to the method: the optimal one to P3m, the others to the particle mesh.
   */
  MENISCUS_STATUS_INFLUENCE_OF_METHOD = 38,
  /**
   * The gradient does not belong to the method: P3m takes the spectral one.
   */
  MENISCUS_STATUS_GRADIENT_OF_METHOD = 39,
  /**
   * An external field is not finite, exceeds 1e8 kBT/R0 somewhere, or is a trap of negative stiffness or with a centre
   * outside the box.
   */
  MENISCUS_STATUS_FIELDS = 40,
  /**
   * The distance of mesh_refresh is neither 0 nor 2^-20 to 16 R0.
   */
  MENISCUS_STATUS_MESH_REFRESH = 41,
  /**
   * The distance of mesh_refresh is not below a quarter of the side.
   */
  MENISCUS_STATUS_MESH_REFRESH_TOO_LARGE = 42,
  /**
   * The program flushes subnormal numbers to zero, which would change the bits.
   */
  MENISCUS_STATUS_SUBNORMALS_FLUSHED = 48,
  /**
   * The program does not round to nearest, which would change the bits.
   */
  MENISCUS_STATUS_ROUNDING = 49,
  /**
   * The parameters ask for another mesh than the engine was created for.
   */
  MENISCUS_STATUS_GRID_MISMATCH = 50,
  /**
   * No disc was given.
   */
  MENISCUS_STATUS_NO_PARTICLES = 51,
  /**
   * More discs were given than the engine was created for.
   */
  MENISCUS_STATUS_TOO_MANY_PARTICLES = 52,
  /**
   * The ids are not 0 to count - 1, each once.
   */
  MENISCUS_STATUS_ID = 53,
  /**
   * A strength exceeds 1000, or the capillary strength times its square exceeds 1000 kBT.
   */
  MENISCUS_STATUS_STRENGTH = 54,
  /**
   * Mesh forces are to be held, and the memory is shorter than meniscus_size_to_hold says.
   */
  MENISCUS_STATUS_NO_ROOM_TO_HOLD = 55,
  /**
   * The held forces are not those of a run of these discs: one is larger than a mesh can exert.
   */
  MENISCUS_STATUS_HELD_FORCE = 56,
  /**
   * There are no discs: no run was set, or setting it failed.
   */
  MENISCUS_STATUS_NOT_INITIALISED = 64,
  /**
   * A mesh node would hold more than 4095 discs, or strengths of more than 2047, or, of more than 524288 discs, more than
   * 32768 would be in one cell of a division of the box into at most 256 x 256.
   */
  MENISCUS_STATUS_CROWDED = 65,
  /**
   * The largest force allows no step of even 2^-40 R0^2/D.
   */
  MENISCUS_STATUS_STEP_TOO_SHORT = 66,
  /**
   * Time would exceed 2^24 R0^2/D, or the number of steps 2^64 - 1.
   */
  MENISCUS_STATUS_TIME_OVERFLOW = 67,
  /**
   * A disc would move by half a box or more.
   */
  MENISCUS_STATUS_HALF_BOX = 68,
  /**
   * The engine's memory was written to by somebody else.
   */
  MENISCUS_STATUS_MEMORY = 69,
  /**
   * No mesh forces are held.
   */
  MENISCUS_STATUS_NOTHING_HELD = 70,
} MeniscusStatus;

/**
 * How the capillary force is summed.
 */
typedef enum {
  /**
   * All of it on the mesh.
   */
  MENISCUS_METHOD_PARTICLE_MESH = 1,
  /**
   * What is smooth on the mesh, with the optimal influence function and the spectral gradient, the rest pair by
   * pair up to a cut-off.
   */
  MENISCUS_METHOD_P3M = 2,
} MeniscusMethod;

/**
 * How a disc's mass is spread over mesh nodes, and the field gathered from them.
 */
typedef enum {
  /**
   * Order 2: linear, 4 nodes.
   */
  MENISCUS_ASSIGNMENT_CLOUD_IN_CELL = 2,
  /**
   * Order 3: quadratic, 9 nodes.
   */
  MENISCUS_ASSIGNMENT_TRIANGULAR_SHAPED_CLOUD = 3,
  /**
   * Order 4: piecewise cubic, 16 nodes.
   */
  MENISCUS_ASSIGNMENT_ORDER4 = 4,
  /**
   * Order 5, 25 nodes.
   */
  MENISCUS_ASSIGNMENT_ORDER5 = 5,
  /**
   * Order 6, 36 nodes.
   */
  MENISCUS_ASSIGNMENT_ORDER6 = 6,
  /**
   * Order 7, 49 nodes.
   */
  MENISCUS_ASSIGNMENT_ORDER7 = 7,
} MeniscusAssignment;

/**
 * Green's function of the interface on the mesh.
 */
typedef enum {
  /**
   * That of the five-point Laplacian.
   */
  MENISCUS_INFLUENCE_PAPER = 1,
  /**
   * The continuum's, 1/(k^2 + kappa^2).
   */
  MENISCUS_INFLUENCE_CONTINUUM = 2,
  /**
   * The one that makes the error of the far part least, for MeniscusMethod P3m only.
   */
  MENISCUS_INFLUENCE_OPTIMAL = 3,
} MeniscusInfluence;

/**
 * How the gradient of the interface is taken.
 */
typedef enum {
  /**
   * i k, with the Nyquist frequency zero.
   */
  MENISCUS_GRADIENT_SPECTRAL = 1,
  /**
   * Two-point central difference.
   */
  MENISCUS_GRADIENT_DIFFERENCE2 = 2,
  /**
   * Four-point central difference.
   */
  MENISCUS_GRADIENT_DIFFERENCE4 = 4,
} MeniscusGradient;

/**
 * Distribution of the thermal displacement; variance 2 dt per component unless none.
 */
typedef enum {
  /**
   * Uniform.
   */
  MENISCUS_NOISE_UNIFORM = 1,
  /**
   * Gaussian.
   */
  MENISCUS_NOISE_GAUSSIAN = 2,
  /**
   * No thermal motion: temperature zero.
   */
  MENISCUS_NOISE_NONE = 3,
} MeniscusNoise;

/**
 * An engine in the caller's memory.
 */
typedef struct MeniscusEngine MeniscusEngine;

/**
 * A run's physical and numerical parameters, in units of R0, kBT and R0^2/D. Begin with
 * meniscus_default_parameters: a choice left 0 is refused.
 */
typedef struct {
  /**
   * Side of the square periodic box, R0; at most 65536.
   */
  double side;
  /**
   * Strength V0 of the capillary attraction, kBT; 0 to 1000, 0 for none.
   */
  double capillary_strength;
  /**
   * Capillary length, R0; at least 0.01, INFINITY allowed.
   */
  double capillary_length;
  /**
   * Splitting of P3m, 1/R0; 1e-5 to 8, and at most 0.7 over the mesh spacing. Not looked at otherwise.
   */
  double splitting;
  /**
   * Cut-off of the near part of P3m, R0; at least 1, below half the side. Not looked at otherwise.
   */
  double cutoff;
  /**
   * How far a disc moves before the force of the mesh is computed anew for all, R0; 0 for every step, else 2^-20 to 16 and
   * below a quarter of the side, for an engine in memory of meniscus_size_to_hold.
   */
  double mesh_refresh;
  /**
   * Uniform external force along x, kBT/R0. No external field exerts more than 1e8 along an axis anywhere.
   */
  double uniform_force_x;
  /**
   * Uniform external force along y, kBT/R0.
   */
  double uniform_force_y;
  /**
   * Stiffness of a harmonic trap that draws every disc, kBT/R0^2; 0 for none.
   */
  double trap_stiffness;
  /**
   * x of the trap's centre, R0; 0 to side.
   */
  double trap_center_x;
  /**
   * y of the trap's centre, R0; 0 to side.
   */
  double trap_center_y;
  /**
   * Ceiling of the time step, R0^2/D; 2^-40 to 1.
   */
  double max_step;
  /**
   * Largest displacement by force in a step, R0; 2^-40 to 0.5.
   */
  double max_displacement;
  /**
   * Seed of the noise, 0 to 2^63 - 1.
   */
  uint64_t seed;
  /**
   * Nodes along a side of the mesh: a power of two, 16 to 4096.
   */
  uint32_t grid;
  /**
   * How the capillary force is summed: a MeniscusMethod.
   */
  uint32_t method;
  /**
   * Mass assignment: a MeniscusAssignment.
   */
  uint32_t assignment;
  /**
   * Influence function: a MeniscusInfluence.
   */
  uint32_t influence;
  /**
   * Gradient: a MeniscusGradient.
   */
  uint32_t gradient;
  /**
   * Thermal motion: a MeniscusNoise.
   */
  uint32_t noise;
  /**
   * Whether discs repel each other at contact: 0 or 1.
   */
  uint32_t repulsion;
} MeniscusParameters;

/**
 * Where a run stands.
 */
typedef struct {
  /**
   * Steps done.
   */
  uint64_t step;
  /**
   * Time, unit 2^-40 R0^2/D.
   */
  uint64_t time;
} MeniscusClock;

/**
 * What a step did.
 */
typedef struct {
  /**
   * Its length, unit 2^-40 R0^2/D.
   */
  uint64_t length;
  /**
   * The largest modulus of the forces before the step, rounded up, unit 2^-24 kBT/R0.
   */
  uint64_t largest_force;
  /**
   * Steps done and time reached after it.
   */
  MeniscusClock clock;
  /**
   * Whether the force of the mesh was computed anew, 0 or 1; always 1 if none is held.
   */
  uint32_t refreshed;
} MeniscusStep;

/**
 * Length and SHA-256 of the canonical bytes of a state.
 */
typedef struct {
  /**
   * Number of bytes.
   */
  uint64_t length;
  /**
   * SHA-256 of the bytes.
   */
  uint8_t sha256[32];
} MeniscusDigest;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Bytes of memory that an engine takes, for a mesh of `grid` nodes a side (a power of two from 16 to 4096) and room
 * for `capacity` discs (1 to 4194304); 0 if one of them is out of range.
 */
size_t meniscus_size(uint32_t grid,
                     size_t capacity);

/**
 * The same for an engine that can hold mesh forces over several steps, mesh_refresh of the parameters: 40 bytes more for
 * each disc.
 */
size_t meniscus_size_to_hold(uint32_t grid,
                             size_t capacity);

/**
 * Alignment of that memory in bytes; what malloc returns is always aligned so.
 */
size_t meniscus_alignment(void);

/**
 * Makes an engine without discs in `length` bytes of the caller's memory, which is lent to it from now on, and
 * writes where it is to `engine` (null if that fails). In memory of meniscus_size_to_hold bytes or more it can hold mesh
 * forces.
 *
 * The memory need not be initialised. It may be freed or used otherwise as soon as the engine is no longer needed.
 * It must not be moved or copied: the copy is no engine.
 *
 * # Safety
 * `memory` is null or points to `length` bytes that nothing else uses; `engine` is null or points to a pointer.
 */
MeniscusStatus meniscus_create(void *memory,
                               size_t length,
                               uint32_t grid,
                               size_t capacity,
                               MeniscusEngine **engine);

/**
 * Starts a run of `count` discs, also where another run was before.
 *
 * `x` and `y` are fractions of the side, unit side / 2^32 (see meniscus_fraction). `ids` are 0 to count - 1, each
 * once, in any order; null if the discs are given in the order of their ids. `strengths` are their capillary strengths,
 * unit 2^-20: discs attract each other with the capillary strength of the parameters times both of theirs, and repel
 * each other if the signs differ; null if all of them are 1, MENISCUS_STRENGTH_ONE. `clock` is where the run stands: null
 * for the start, the clock of a state reached before to go on as if the run had never stopped (with meniscus_hold if mesh
 * forces were held). Crossings and forces are 0 then. If anything is refused, the engine has no discs.
 *
 * # Safety
 * `engine` is null or from meniscus_create and used by nobody else meanwhile. Each other pointer is null or points
 * to what its type says, `ids`, `x`, `y` and `strengths` to `count` of them, outside the engine's memory.
 */
MeniscusStatus meniscus_set(MeniscusEngine *engine,
                            const MeniscusParameters *parameters,
                            const MeniscusClock *clock,
                            const uint32_t *ids,
                            const uint32_t *x,
                            const uint32_t *y,
                            const int32_t *strengths,
                            size_t count);

/**
 * Goes on with the mesh forces that were held where the run stands, as meniscus_held wrote them: after meniscus_set with the
 * clock and positions of that state, so that the run goes on as if it had never stopped. A run that holds none ignores
 * them. If they are refused, none are held.
 *
 * # Safety
 * `engine` is null or from meniscus_create and used by nobody else meanwhile. Each other pointer is null or points to
 * `count` values outside the engine's memory.
 */
MeniscusStatus meniscus_hold(MeniscusEngine *engine,
                             const uint32_t *reference_x,
                             const uint32_t *reference_y,
                             const int64_t *force_x,
                             const int64_t *force_y,
                             size_t count);

/**
 * Does one step and writes what happened to `step`, which may be null. If the step is refused, the state is as it
 * was.
 *
 * # Safety
 * `engine` is null or from meniscus_create and used by nobody else meanwhile; `step` is null or points to a
 * MeniscusStep outside the engine's memory.
 */
MeniscusStatus meniscus_step(MeniscusEngine *engine,
                             MeniscusStep *step);

/**
 * Computes the forces at the present positions, for meniscus_forces. The state stays as it is.
 *
 * # Safety
 * `engine` is null or from meniscus_create and used by nobody else meanwhile.
 */
MeniscusStatus meniscus_compute_forces(MeniscusEngine *engine);

/**
 * Number of discs; 0 before a run is set, and for no engine.
 *
 * # Safety
 * `engine` is null or from meniscus_create and not changed meanwhile.
 */
size_t meniscus_count(const MeniscusEngine *engine);

/**
 * Writes how many steps were done and what time was reached to `clock`.
 *
 * # Safety
 * `engine` is null or from meniscus_create and not changed meanwhile; `clock` is null or points to a MeniscusClock
 * outside the engine's memory.
 */
MeniscusStatus meniscus_clock(const MeniscusEngine *engine,
                              MeniscusClock *clock);

/**
 * Writes the positions in the order of the ids to `x` and `y`, unit side / 2^32.
 *
 * # Safety
 * `engine` is null or from meniscus_create and not changed meanwhile; `x` and `y` are null or point to `length`
 * numbers outside the engine's memory.
 */
MeniscusStatus meniscus_positions(const MeniscusEngine *engine,
                                  uint32_t *x,
                                  uint32_t *y,
                                  size_t length);

/**
 * Writes how many borders each disc has crossed since the run was set, in the order of the ids, + to the right and
 * up.
 *
 * # Safety
 * `engine` is null or from meniscus_create and not changed meanwhile; `x` and `y` are null or point to `length`
 * numbers outside the engine's memory.
 */
MeniscusStatus meniscus_crossings(const MeniscusEngine *engine,
                                  int32_t *x,
                                  int32_t *y,
                                  size_t length);

/**
 * Writes the forces as last computed, by meniscus_step before it moved the discs or by meniscus_compute_forces, in
 * the order of the ids, unit 2^-24 kBT/R0.
 *
 * # Safety
 * `engine` is null or from meniscus_create and not changed meanwhile; `x` and `y` are null or point to `length`
 * numbers outside the engine's memory.
 */
MeniscusStatus meniscus_forces(const MeniscusEngine *engine,
                               int64_t *x,
                               int64_t *y,
                               size_t length);

/**
 * Writes the mesh forces that are held, and where the discs were when they were computed, in the order of the ids: x and y in
 * units of side / 2^32, forces in 2^-24 kBT/R0. They belong to the state, and meniscus_hold takes them. Before the first step
 * nothing is held, nor ever without mesh_refresh.
 *
 * # Safety
 * `engine` is null or from meniscus_create and not changed meanwhile; the other pointers are null or point to `length`
 * numbers outside the engine's memory.
 */
MeniscusStatus meniscus_held(const MeniscusEngine *engine,
                             uint32_t *reference_x,
                             uint32_t *reference_y,
                             int64_t *force_x,
                             int64_t *force_y,
                             size_t length);

/**
 * Writes length and SHA-256 of the canonical bytes of the state to `digest`.
 *
 * # Safety
 * `engine` is null or from meniscus_create and not changed meanwhile; `digest` is null or points to a
 * MeniscusDigest outside the engine's memory.
 */
MeniscusStatus meniscus_digest(const MeniscusEngine *engine, MeniscusDigest *digest);

/**
 * Writes the SHA-256 of `digest` as 64 hexadecimal digits and a zero to `text`, which has room for 65 characters.
 *
 * # Safety
 * `digest` is null or points to a MeniscusDigest; `text` is null or points to 65 characters.
 */
MeniscusStatus meniscus_digest_text(const MeniscusDigest *digest,
                                    char *text);

/**
 * Writes the fraction of the side nearest to `coordinate` to `fraction`, unit side / 2^32. `coordinate` and `side`
 * in R0, 0 <= coordinate < side. Back again: fraction * (side / 4294967296.0).
 *
 * # Safety
 * `fraction` is null or points to a number.
 */
MeniscusStatus meniscus_fraction(double side,
                                 double coordinate,
                                 uint32_t *fraction);

/**
 * What a MeniscusStatus means, in one line that lives as long as the program. Never null.
 */
const char *meniscus_status_message(int32_t status);

/**
 * Discs of the paper's Table I in a box of 64 R0, with the paper's force on a mesh of 64 nodes a side.
 */
MeniscusParameters meniscus_default_parameters(void);

/**
 * The same parameters with the capillary force split on their mesh: order 5, splitting 0.5/h, cut-off 7 h, which errs
 * by about 1e-4 of the root mean square force of discs at random. As given if a choice in them does not exist.
 */
MeniscusParameters meniscus_with_p3m(MeniscusParameters parameters);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MENISCUS_H */
