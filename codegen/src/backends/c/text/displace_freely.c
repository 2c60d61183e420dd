/* Moves a pose by six components of a velocity: the position, and the orientation, whose rotation vector the last three
 * are. */
static void rob_displace_freely(double *pose, const double *step)
{
    for (int i = 0; i < 3; i++) {
        pose[i] += step[i];
    }
    rob_turn(pose, &step[3]);
}

