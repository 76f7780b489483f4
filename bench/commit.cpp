// The commit that was compiled. In a file of its own, because it is compiled again after each commit.
namespace flaunay::bench {

const char* commit();

const char* commit() { return FLAUNAY_COMMIT; }

}  // namespace flaunay::bench
