#include "guidance.h"

#include <math.h>
#include <string.h>

#define DEGENERATE 1e-9 /* sine of the angle between chaser and axis, below which they are one line */

enum { AT_START, AT_HORIZON, AT_STAGE }; /* when something that rotates is taken */
enum { GREAT_CIRCLE, UPRIGHT };          /* how the keep-out planes turn */
enum { FACES = 4 };

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void rotated(const double axis[3], double angle, double out[3])
{
    double c = cos(angle), s = sin(angle);
    out[0] = c * axis[0] - s * axis[1];
    out[1] = s * axis[0] + c * axis[1];
    out[2] = axis[2];
}

/* Outward unit normals of the faces of a cone about an axis in the orbit's plane. */
static void cone_faces(const double axis[3], double tangent, double out[FACES][3])
{
    double norm = 1.0 / sqrt(1.0 + tangent * tangent);
    for (int face = 0; face < FACES; face++) {
        double sign = 1.0 - 2.0 * (face % 2);
        for (int k = 0; k < 3; k++)
            out[face][k] = -tangent * norm * axis[k];
        if (face < 2) {
            out[face][0] -= sign * norm * axis[1];
            out[face][1] += sign * norm * axis[0];
        } else {
            out[face][2] += sign * norm;
        }
    }
}

static bool in_cone(const double position[3], const double axis[3], double tangent)
{
    double faces[FACES][3];
    cone_faces(axis, tangent, faces);
    for (int face = 0; face < FACES; face++)
        if (dot(faces[face], position) > 0.0)
            return false;
    return true;
}

/* Outward normals of the rotating keep-out plane (3.5, 3.6). */
static void keep_out_normals(const double position[3], const double axis[3], int steps,
                             double largest_angle, int turn_rule, double out[][3])
{
    double first[3] = {position[0], position[1], turn_rule == UPRIGHT ? 0.0 : position[2]};
    double radius = sqrt(dot(first, first)), tangent[3];
    for (int k = 0; k < 3; k++)
        first[k] = radius > DEGENERATE * fabs(position[2]) ? first[k] / radius : axis[k];
    double cosine = dot(first, axis);
    for (int k = 0; k < 3; k++)
        tangent[k] = axis[k] - cosine * first[k];
    double sine = sqrt(dot(tangent, tangent));
    if (sine > DEGENERATE) {
        for (int k = 0; k < 3; k++)
            tangent[k] /= sine;
    } else {
        tangent[0] = first[1];
        tangent[1] = -first[0];
        tangent[2] = 0.0;
    }
    double turn = atan2(sine, cosine) / steps;
    if (turn > largest_angle)
        turn = tangent[0] * first[1] < tangent[1] * first[0] ? -largest_angle : largest_angle;
    for (int i = 0; i <= steps; i++) {
        double c = cos(i * turn), s = sin(i * turn);
        for (int k = 0; k < 3; k++)
            out[i][k] = c * first[k] + s * tangent[k];
    }
}

static double time_of(int rule, double time, int stage, int stages, double sample_time)
{
    if (rule == AT_START)
        return time;
    return time + (rule == AT_HORIZON ? stages : stage) * sample_time;
}

/* A point on the turned axis, m, and, if the law wants it, its velocity. */
static void reference(const struct law *law, double distance, double angle, double out[STATES])
{
    double axis[3];
    rotated(law->axis, angle, axis);
    for (int k = 0; k < 3; k++) {
        out[k] = distance * axis[k];
        out[3 + k] = 0.0;
    }
    if (law->reference_moves) {
        out[3] = -law->rotation_rate * out[1];
        out[4] = law->rotation_rate * out[0];
    }
}

static void write_cost(const struct law *law, enum phase phase, double time, struct program *p)
{
    memcpy(p->transition, law->transitions[phase], sizeof p->transition);
    memcpy(p->state_hessian, law->state_hessians[phase], sizeof p->state_hessian);
    memcpy(p->terminal_hessian, law->terminal_hessians[phase], sizeof p->terminal_hessian);
    memcpy(p->control_hessian, law->control_hessians[phase], sizeof p->control_hessian);
    double distance = phase == DOCKING ? law->port : law->set_points[phase], point[STATES];
    int rule = phase == DOCKING ? AT_STAGE : (int)law->set_point_time;
    for (int i = 1; i <= p->stages; i++) {
        double at = time_of(rule, time, i, p->stages, law->sample_times[phase]);
        reference(law, distance, law->rotation_rate * at, point);
        for (int k = 0; k < STATES; k++)
            point[k] /= law->scales[phase][k];
        for (int j = 0; j < STATES; j++) {
            double total = 0.0;
            if (i < p->stages)
                total = -p->state_hessian[j] * point[j];
            else
                for (int k = 0; k < STATES; k++)
                    total -= p->terminal_hessian[j][k] * point[k];
            p->state_gradient[i][j] = total;
        }
    }
}

static void set_plane(struct program *p, int stage, double sign, const double normal[3],
                      double offset, double weight)
{
    int row = p->plane_count[stage]++;
    for (int k = 0; k < 3; k++)
        p->normals[stage][row][k] = sign * normal[k];
    p->offsets[stage][row] = offset;
    p->plane_weights[stage][row] = weight;
}

/* The far range's planes, and its cone at the end. */
static void write_keep_out(const struct law *law, const double state[STATES], double time,
                           struct program *p)
{
    static double normals[STAGES + 1][3];
    double axis[3], faces[FACES][3], length = law->scales[RENDEZVOUS][0];
    double sample_time = law->sample_times[RENDEZVOUS];
    double at = time_of((int)law->terminal_cone_time, time, p->stages, p->stages, sample_time);
    rotated(law->axis, law->rotation_rate * at, axis);
    keep_out_normals(state, axis, p->stages, law->plane_rate * sample_time, (int)law->plane_turn,
                     normals);
    for (int i = 1; i <= p->stages; i++)
        set_plane(p, i, -1.0, normals[i], -law->keep_out / length, law->hard_weights[RENDEZVOUS]);
    cone_faces(axis, law->tangents[RENDEZVOUS], faces);
    for (int face = 0; face < FACES; face++)
        set_plane(p, p->stages, 1.0, faces[face], 0.0, law->penalties[RENDEZVOUS]);
}

/* The cone of each stage, and the mid range's plane. */
static void write_corridor(const struct law *law, enum phase phase, double time, struct program *p)
{
    double axis[3], faces[FACES][3], length = law->scales[phase][0];
    double tip = phase == DOCKING ? law->port : 0.0;
    double weight = phase == DOCKING ? law->hard_weights[phase] : law->penalties[phase];
    for (int i = 1; i <= p->stages; i++) {
        rotated(law->axis, law->rotation_rate * (time + i * law->sample_times[phase]), axis);
        cone_faces(axis, law->tangents[phase], faces);
        for (int face = 0; face < FACES; face++)
            set_plane(p, i, 1.0, faces[face], tip * dot(faces[face], axis) / length, weight);
        if (phase == APPROACH)
            set_plane(p, i, -1.0, axis, -law->overshoot / length, law->hard_weights[phase]);
    }
}

/* The bounds on the velocity while docking. */
static void write_speed_bound(const struct law *law, struct program *p)
{
    p->bound_count = BOUNDS;
    for (int b = 0; b < BOUNDS; b++) {
        p->components[b] = 3 + b / 2;
        p->signs[b] = 1.0 - 2.0 * (b % 2);
        for (int i = 1; i <= p->stages; i++) {
            p->bounds[i][b] = law->speed_bound / law->scales[DOCKING][3];
            p->bound_weights[i][b] = law->hard_weights[DOCKING];
        }
    }
}

void write_program(const struct law *law, enum phase phase, const double state[STATES], double time,
                   struct program *p, double start[STATES])
{
    p->stages = (int)law->horizons[phase];
    p->bound_count = 0;
    memset(p->plane_count, 0, sizeof p->plane_count);
    write_cost(law, phase, time, p);
    if (phase == RENDEZVOUS)
        write_keep_out(law, state, time, p);
    else
        write_corridor(law, phase, time, p);
    if (phase == DOCKING)
        write_speed_bound(law, p);
    for (int k = 0; k < STATES; k++)
        start[k] = state[k] / law->scales[phase][k];
}

bool phase_ended(const struct law *law, enum phase phase, const double state[STATES], double time)
{
    double axis[3], offset[3], tip = phase == DOCKING ? law->port : 0.0;
    rotated(law->axis, law->rotation_rate * time, axis);
    for (int k = 0; k < 3; k++)
        offset[k] = state[k] - tip * axis[k];
    if (phase == RENDEZVOUS && !in_cone(state, axis, law->tangents[phase]))
        return false;
    double distance = law->switches[phase] ? dot(offset, axis) : sqrt(dot(offset, offset));
    return distance <= law->switch_distances[phase];
}
