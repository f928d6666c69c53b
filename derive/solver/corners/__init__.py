"""Where singularities meet: angles are moved to where later steps have solutions, or free where no digits are left."""
