/* Moves a pose that ends with a unit quaternion: the last three numbers of a step are a rotation vector in the base
 * frame. */
static void rob_displace(double *pose, const double *step)
{
    for (int i = 0; i < (ROB_DOF - 3); i++) {
        pose[i] += step[i];
    }
    rob_turn(pose, &step[ROB_DOF - 3]);
}
