"""Why a machine is refused, with the joints and the amounts that a person can act on.

neighbours: what a refused arm misses: axes that do not meet, tasks that fit
no_pose: the reason why a machine has no pose at its nominal dimensions
"""
