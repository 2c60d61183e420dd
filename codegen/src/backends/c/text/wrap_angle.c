/* The angle nearest to zero that differs from another one by whole turns. */
static double rob_wrap_angle(double angle)
{
    return (fabs(angle) <= 3.141592653589793) ? angle : atan2(sin(angle), cos(angle));
}
