// trichrome-mpi: one of the processes that mpirun (or srun) started.

#include "engine/base/check.h"
#include "ui/cli/interrupt.h"
#include "ui/cli/ranks.h"

#include <algorithm>

#define OMPI_SKIP_MPICXX // the C interface alone
#include <mpi.h>

namespace ui
{

namespace
{

constexpr int RECORD = 1; // message tag

class Mpi : public Ranks
{
  public:
    Mpi()
    {
        MPI_Init(nullptr, nullptr); // on failure MPI says so and ends the processes
        MPI_Comm_rank(MPI_COMM_WORLD, &index_);
        MPI_Comm_size(MPI_COMM_WORLD, &count_);
    }
    uint32_t index() const override { return uint32_t(index_); }
    uint32_t count() const override { return uint32_t(count_); }
    int meet() const override { return meetWith({}); }

    void sum(std::vector<double>& values) const override
    {
        MPI_Allreduce(MPI_IN_PLACE, values.data(), int(values.size()), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    }

    std::vector<Bytes> gather(const std::vector<Bytes>& records) const override
    {
        const int own = int(records.size());
        std::vector<int> counts(size_t(count_), 0);
        MPI_Gather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
        if (index_ != 0) {
            for (const Bytes& record : records)
                MPI_Send(record.data(), int(record.size()), MPI_BYTE, 0, RECORD, MPI_COMM_WORLD);
            return {};
        }
        std::vector<Bytes> all = records;
        for (int rank = 1; rank < count_; ++rank)
            for (int i = 0; i < counts[size_t(rank)]; ++i) {
                MPI_Status status;
                int size = 0;
                MPI_Probe(rank, RECORD, MPI_COMM_WORLD, &status);
                MPI_Get_count(&status, MPI_BYTE, &size);
                all.emplace_back(size_t(size));
                MPI_Recv(all.back().data(), size, MPI_BYTE, rank, RECORD, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
            }
        return all;
    }

    int finish(const Ending& ending) const override
    {
        int exitCode = ending.exitCode;
        if (!met_ && exitCode != 0) {
            exitCode = meetWith(ending);
        } else if (exitCode != 0 && exitCode != Interrupt::exitCode() && !calledOff_) {
            Ranks::finish(ending);
            MPI_Abort(MPI_COMM_WORLD, exitCode); // else the others wait
        }
        MPI_Finalize();
        return exitCode;
    }

  private:
    int meetWith(const Ending& own) const
    {
        met_ = true;
        std::vector<int> codes(size_t(count_), 0);
        MPI_Allgather(&own.exitCode, 1, MPI_INT, codes.data(), 1, MPI_INT, MPI_COMM_WORLD);
        const auto failed = std::ranges::find_if(codes, [](int code) { return code != 0; });
        if (failed == codes.end()) return 0;
        calledOff_ = true;
        if (failed - codes.begin() == index_) Ranks::finish(own);
        return *failed;
    }

    int index_ = 0, count_ = 1;
    mutable bool met_ = false, calledOff_ = false;
};

} // namespace

const Ranks& ranks()
{
    static const Mpi MPI;
    return MPI;
}

} // namespace ui
