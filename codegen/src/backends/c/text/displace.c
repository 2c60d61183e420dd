/* Moves a pose by a small displacement along the twist coordinates. */
static void rob_displace(double *pose, const double *step)
{
    for (int i = 0; i < ROB_DOF; i++) {
        pose[i] += step[i];
    }
}
