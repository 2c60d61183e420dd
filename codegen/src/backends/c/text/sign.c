/* Sign of a velocity as Coulomb friction wants it: -1, 0 or 1. */
static double rob_sign(double velocity)
{
    return (double)((velocity > 0.0) - (velocity < 0.0));
}
