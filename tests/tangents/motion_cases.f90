! The same motions of a point as the tests of kinematics.
include '../kinematics/motion_cases.f90'
